// Change of the load on a real car: the body pitches with all its radars. It is to be reported as a change of the load,
// not of a radar; the mounting on the body stays as it was.
#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/axis_errors.hpp"
#include "tests/benchmarks/alignment/common/changes.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/alignment/common/real_car_drives.hpp"
#include "tests/benchmarks/common/parallel.hpp"

namespace boresight::bench {

namespace {

constexpr double kReportedWithin_s = 30.0;

struct LoadOutcome {
  LoadReports load;
  double load_s = 0.0;
  Run run;
};

LoadOutcome drive_with_load(double size_deg, std::size_t i, double duration_s, std::uint64_t seed,
                            const MakeMethod& make, bool is_quick) {
  simulator::AlignmentSpec spec = real_car_drive(road_in_turn(i), duration_s, seed);
  spec.real_car.load_pitch_rad = (i % 2 == 0 ? 1.0 : -1.0) * size_deg * kRadiansPerDegree;
  spec.real_car.load_time_s = is_quick ? 0.5 * duration_s : draw_change_s(seed);
  LoadOutcome outcome;
  outcome.load_s = spec.real_car.load_time_s;
  RunOptions run_options;
  run_options.snapshot_period_s = 0.5;
  run_options.false_changes = true;
  run_options.look = [&](const alignment::Method& method, double time_s) { outcome.load.look(method, time_s); };
  outcome.run = run_drive(spec, make, run_options);
  return outcome;
}

}  // namespace

void real_car_load(const Options& options, Report& report) {
  const std::size_t drives = options.seeds(24);
  const double duration_s = options.seconds(180.0);
  const NamedMethod own = own_method(options.method);
  std::uint64_t seed = first_seed_of(FreshSeeds::kLoad, options);
  Table table{
      "real_car_load",
      "method `" + own_method_name(options.method) +
          "`, real_car, load changed at a random time from 60 to 120 s, nose up and down. Delay of the report "
          "in s, median (95 % interval). Share reported within 30 s. Reports of a load before. Sudden changes "
          "of a radar reported after and before. Pitch of the mounting at the end, rms (95 % interval) and 95 % "
          "quantile. Its NEES. " +
          drives_text(drives, duration_s, seed),
      {"load", "delay s", "in 30 s, %", "load before", "radar after", "radar before", "pitch °", "95 % °",
       "NEES pitch"},
      {}};
  for (const double size_deg : {0.8, 0.3}) {
    std::vector<LoadOutcome> outcomes(drives);
    parallel_for(drives, options.jobs, [&](std::size_t i) {
      outcomes[i] = drive_with_load(size_deg, i, duration_s, seed + i, own.make, options.quick);
    });
    std::vector<double> delays_s;
    std::size_t load_before = 0, radar_before = 0, radar_after = 0, in_time = 0;
    DriveErrors errors;
    for (const LoadOutcome& outcome : outcomes) {
      delays_s.push_back(outcome.load.delay_s(outcome.load_s));
      in_time += delays_s.back() <= kReportedWithin_s ? 1 : 0;
      load_before += outcome.load.before(outcome.load_s);
      for (const StepChangeSeen& seen : outcome.run.step_changes) {
        ++(seen.time_s < outcome.load_s ? radar_before : radar_after);
      }
      errors.add_drive(outcome.run.last());
    }
    const AxisErrors& pitch = errors.of(kPitch);
    const Interval rms = pitch.rms_interval();
    const Interval rms_deg{rms.low / kRadiansPerDegree, rms.high / kRadiansPerDegree};
    const double in_time_percent = 100.0 * static_cast<double>(in_time) / static_cast<double>(drives);
    const std::string name = "load " + number(size_deg) + "°";
    table.rows.push_back({number(size_deg) + "°", with_interval(median(delays_s), median_interval(delays_s)),
                          fixed(in_time_percent, 0), std::to_string(load_before), std::to_string(radar_after),
                          std::to_string(radar_before), with_interval(pitch.rms() / kRadiansPerDegree, rms_deg),
                          number(pitch.size_quantile(0.95) / kRadiansPerDegree),
                          with_interval(pitch.nees(), pitch.nees_interval())});
    const std::string how = drives_text(drives, duration_s, seed) + ", nose up and down";
    const bool is_large = size_deg > 0.5;
    if (is_large) {
      const Interval of_median = median_interval(delays_s);
      report.at_most("load", name + ": delay", median(delays_s), kReportedWithin_s, "s",
                     "median over " + how + "; 95 % interval " + number(of_median.low) + "–" + number(of_median.high));
      report.at_least("load", name + ": reported within 30 s", in_time_percent, 95.0, "%", how);
      report.at_most("load", name + ": pitch of the mounting at the end, rms", pitch.rms() / kRadiansPerDegree, 0.1,
                     "°", how + "; 95 % interval " + number(rms_deg.low) + "–" + number(rms_deg.high));
    } else {
      report.beside("load", name + ": reported within 30 s", in_time_percent, "%", how);
      report.beside("load", name + ": pitch of the mounting at the end, rms", pitch.rms() / kRadiansPerDegree, "°",
                    how + "; 95 % interval " + number(rms_deg.low) + "–" + number(rms_deg.high));
    }
    report.at_most("load", name + ": sudden changes of a radar reported after it", static_cast<double>(radar_after),
                   0.0, "", how);
    seed += kSeedsOfAKind;
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
