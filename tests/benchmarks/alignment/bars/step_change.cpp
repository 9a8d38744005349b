// A step change (sudden misalignment) of one radar: delay until it is reported, whether the right radar is named, the
// error afterwards, and whether the stated std covers that error. The bars for 0.5° yaw and 1° pitch are our own.
#include <cmath>

#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

namespace {

using simulator::AlignmentSpec;
using simulator::RoadKind;

constexpr double kStepChangeAt_s = 60.0;

struct StepChangeCase {
  const char* name;
  int parameter;
  Eigen::Vector3d rotation_deg;  ///< about vehicle axes; the sign alternates from seed to seed
  double bar_s;                  ///< 0: not judged
};

const StepChangeCase kStepChangeCases[] = {
    {"1° yaw", kYaw, {0.0, 0.0, 1.0}, 3.0},       {"2° pitch", kPitch, {0.0, 2.0, 0.0}, 6.0},
    {"0.5° yaw", kYaw, {0.0, 0.0, 0.5}, 10.0},    {"1° pitch", kPitch, {0.0, 1.0, 0.0}, 10.0},
    {"0.25° yaw", kYaw, {0.0, 0.0, 0.25}, 0.0},   {"0.1° yaw", kYaw, {0.0, 0.0, 0.1}, 0.0},
    {"0.5° pitch", kPitch, {0.0, 0.5, 0.0}, 0.0}, {"2° roll", kRoll, {2.0, 0.0, 0.0}, 0.0},
    {"5° yaw", kYaw, {0.0, 0.0, 5.0}, 0.0},
};

struct StepChangeOutcome {
  std::vector<double> delays_s;  ///< infinite if it was never reported
  double wrong_radar = 0.0;      ///< reports for a radar that was not moved
};

StepChangeOutcome outcome_of(const std::vector<AlignmentSpec>& specs, const std::vector<Run>& runs) {
  StepChangeOutcome out;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const simulator::StepChange& step_change = specs[i].step_changes.front();
    double delay_s = std::numeric_limits<double>::infinity();
    for (const StepChangeSeen& seen : runs[i].step_changes) {
      if (seen.radar != step_change.radar || seen.time_s < kStepChangeAt_s) {
        out.wrong_radar += 1.0;
      } else if (std::isinf(delay_s)) {
        delay_s = seen.time_s - kStepChangeAt_s;
      }
    }
    out.delays_s.push_back(delay_s);
  }
  return out;
}

}  // namespace

void step_change(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(32);
  Table table{"step_change",
              "seconds from the step change until it is reported: median (95 % quantile)",
              {"step change", "road", "delay s", "never reported", "wrong radar reported", "error 20 s later °",
               "NEES 20 s later"},
              {}};
  for (const StepChangeCase& one : kStepChangeCases) {
    std::vector<double> all_delays_s;
    for (const bool with_disturbances : {false, true}) {
      std::vector<AlignmentSpec> specs;
      for (std::size_t seed = 0; seed < seeds; ++seed) {
        AlignmentSpec spec = with_disturbances ? disturbed_drive(RoadKind::kMixed, 90.0, 3000 + seed)
                                               : clean_drive(RoadKind::kMixed, 90.0, 3000 + seed);
        const double sign = seed / 4 % 2 == 0 ? 1.0 : -1.0;  // measurement times start at 1 s
        spec.step_changes.push_back({1.0 + kStepChangeAt_s, seed % 4, sign * one.rotation_deg * kRadiansPerDegree});
        specs.push_back(spec);
      }
      RunOptions run_options;
      run_options.snapshot_period_s = 0.25;
      const auto runs = run_drives(specs, own_method(options.method).make, options, run_options);
      const StepChangeOutcome outcome = outcome_of(specs, runs);
      all_delays_s.insert(all_delays_s.end(), outcome.delays_s.begin(), outcome.delays_s.end());
      std::vector<double> later, later_normalised;
      Curve response{"step_change", one.name, with_disturbances ? "disturbed" : "clean", {}};
      for (std::size_t s = 0; s < runs.front().snapshots.size(); ++s) {
        const double time_s = runs.front().snapshots[s].time_s - kStepChangeAt_s;
        if (time_s < -5.0) continue;
        std::vector<double> errors, normalised;
        for (std::size_t i = 0; i < runs.size(); ++i) {
          if (s >= runs[i].snapshots.size()) continue;
          const RadarError& radar = runs[i].snapshots[s].radars[specs[i].step_changes[0].radar];
          errors.push_back(std::abs(radar.error(one.parameter)));
          normalised.push_back(radar.error(one.parameter) / radar.std(one.parameter));
        }
        response.points.emplace_back(time_s, median(errors) / kRadiansPerDegree);
        if (time_s >= 20.0 && later.empty()) {
          later = errors;
          later_normalised = normalised;
        }
      }
      report.add(std::move(response));
      table.rows.push_back({one.name, with_disturbances ? "mixed, disturbed" : "mixed",
                            number(median(outcome.delays_s)) + " (" + number(quantile(outcome.delays_s, 0.95)) + ")",
                            fixed(static_cast<double>(std::count_if(outcome.delays_s.begin(), outcome.delays_s.end(),
                                                                    [](double d) { return std::isinf(d); })),
                                  0) +
                                " of " + std::to_string(seeds),
                            fixed(outcome.wrong_radar, 0), number(median(later) / kRadiansPerDegree),
                            number(std::pow(root_mean_square(later_normalised), 2))});
    }
    if (one.bar_s > 0.0) {
      report.at_most("step change", one.name, median(all_delays_s), one.bar_s, "s",
                     "median over 2 × " + std::to_string(seeds) +
                         " seeds, each radar in turn, both signs, half of the drives disturbed; 95 % quantile: " +
                         number(quantile(all_delays_s, 0.95)) + " s");
    }
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
