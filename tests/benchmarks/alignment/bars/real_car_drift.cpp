// Slow drift of one radar's mounting: 0.4° of yaw in three minutes, in steps of a second. How far the estimate is
// behind at the end, and whether the stated std admits it. Methods cannot report a drift yet.
#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/axis_errors.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"
#include "tests/benchmarks/alignment/common/real_car_drives.hpp"

namespace boresight::bench {

namespace {

constexpr double kDrift_rad = 0.4 * kRadiansPerDegree;

/// A drift by the same amount each second, which ends with the drive.
void add_drift(simulator::AlignmentSpec& spec, std::size_t radar, double drift_rad) {
  const auto steps = static_cast<std::size_t>(spec.duration_s);
  for (std::size_t i = 0; i < steps; ++i) {
    const double step_rad = drift_rad / static_cast<double>(steps);
    spec.step_changes.push_back({1.0 + static_cast<double>(i), radar, {0.0, 0.0, step_rad}});  // times start at 1 s
  }
}

}  // namespace

void real_car_drift(const Options& options, Report& report) {
  const std::size_t drives = options.seeds(24);
  const double duration_s = options.seconds(180.0);
  const NamedMethod own = own_method(options.method);
  std::uint64_t seed = first_seed_of(FreshSeeds::kDrift, options);
  Table table{"real_car_drift",
              "method `" + own_method_name(options.method) + "`: yaw of a radar that turns by " +
                  number(kDrift_rad / kRadiansPerDegree) + "° in " + fixed(duration_s, 0) +
                  " s, at the end: median of the error's size (95 % interval), 95 % quantile, NEES. Sudden changes "
                  "reported. Each radar in turn, both signs",
              {"car", "error °", "95 % °", "NEES yaw", "covered, %", "sudden changes"},
              {}};
  for (const bool is_real_car : {false, true}) {
    std::vector<simulator::AlignmentSpec> specs;
    for (std::size_t i = 0; i < drives; ++i) {
      const simulator::RoadKind road = road_in_turn(i);
      specs.push_back(is_real_car ? real_car_drive(road, duration_s, seed + i)
                                  : clean_drive(road, duration_s, seed + i));
      add_drift(specs.back(), i % 4, i / 4 % 2 == 0 ? kDrift_rad : -kDrift_rad);
    }
    RunOptions run_options;
    run_options.snapshot_period_s = run_options.fine_period_s = duration_s;
    const auto runs = run_drives(specs, own.make, options, run_options);
    DriveErrors errors;
    std::vector<double> sizes_deg;
    std::size_t changes = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      errors.add_drive(runs[i].last(), {i % 4});
      sizes_deg.push_back(std::abs(runs[i].last().radars[i % 4].error(kYaw)) / kRadiansPerDegree);
      changes += runs[i].step_changes.size();
    }
    const AxisErrors& yaw = errors.of(kYaw);
    const Interval of_median = median_interval(sizes_deg), of_nees = yaw.nees_interval();
    const std::string car = is_real_car ? "real_car" : "without other effects";
    table.rows.push_back({car, with_interval(median(sizes_deg), of_median), number(quantile(sizes_deg, 0.95)),
                          with_interval(yaw.nees(), of_nees), fixed(yaw.covered_percent(), 0),
                          std::to_string(changes)});
    const std::string how = drives_text(drives, duration_s, seed) + ", each radar in turn, both signs; 95 % interval ";
    const std::string of_error = how + number(of_median.low) + "–" + number(of_median.high);
    const std::string of_consistency = how + number(of_nees.low) + "–" + number(of_nees.high);
    if (is_real_car) {
      report.beside("drift", "yaw at the end, median, " + car, median(sizes_deg), "°", of_error);
      report.beside("drift", "NEES yaw, " + car, yaw.nees(), "", of_consistency);
    } else {
      report.at_most("drift", "yaw at the end, median", median(sizes_deg), 0.02, "°", of_error);
      report.at_most("drift", "NEES yaw", yaw.nees(), 3.0, "", of_consistency);
    }
    seed += kSeedsOfAKind;
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
