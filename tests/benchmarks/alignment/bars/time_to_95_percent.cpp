// Time until an estimate has removed 95 % of the initial error, against truth.
#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

void time_to_95_percent(const Options& options, Report& report) {
  using simulator::RoadKind;
  const std::size_t seeds = options.seeds(24);
  Table table{"time_to_95",
              "seconds of driving until 95 % of the initial error is removed, first time (permanently), "
              "all radars of all drives: median and 90 % quantile",
              {"road", "k_v", "yaw", "pitch", "yaw, 90 %", "pitch, 90 %"},
              {}};
  // Initial errors of at least half a degree, or 0.5 % of k_v: 5 % of a smaller one disappears in the noise.
  const auto least = [](int parameter) { return parameter == kSpeedScale ? 0.005 : 0.5 * kRadiansPerDegree; };
  double worst_yaw = 0.0, worst_pitch = 0.0;
  for (const RoadKind road : {RoadKind::kCity, RoadKind::kMotorway, RoadKind::kMixed}) {
    for (const bool with_disturbances : {false, true}) {
      std::vector<simulator::AlignmentSpec> specs;
      for (std::size_t seed = 0; seed < seeds; ++seed) {
        specs.push_back(with_disturbances ? disturbed_drive(road, options.seconds(120.0), 700 + seed)
                                          : clean_drive(road, options.seconds(120.0), 700 + seed));
      }
      const auto runs = run_drives(specs, own_method(options.method).make, options);
      std::vector<std::string> row = {std::string(name_of(road)) + (with_disturbances ? ", disturbed" : "")};
      std::vector<std::string> tail;
      for (const int parameter : {kSpeedScale, kYaw, kPitch}) {
        std::vector<double> first, stays;
        for (const Run& run : runs) {
          for (std::size_t r = 0; r < run.last().radars.size(); ++r) {
            const TimeTo95 time = time_to_95(run, r, parameter, least(parameter));
            if (std::isnan(time.first_s)) continue;
            first.push_back(time.first_s);
            stays.push_back(time.stays_s);
          }
        }
        row.push_back(number(median(first)) + " (" + number(median(stays)) + ")");
        if (parameter != kSpeedScale) {
          tail.push_back(number(quantile(first, 0.9)) + " (" + number(quantile(stays, 0.9)) + ")");
        }
        if (with_disturbances) continue;
        if (parameter == kYaw) worst_yaw = std::max(worst_yaw, median(stays));
        if (parameter == kPitch) worst_pitch = std::max(worst_pitch, median(stays));
      }
      row.insert(row.end(), tail.begin(), tail.end());
      table.rows.push_back(row);
    }
  }
  const std::string how = "permanently; clean drives, median over " + std::to_string(seeds) +
                          " seeds × 4 radars, worst of 3 road kinds; initial errors of 0.5° or more";
  report.at_most("time to 95 %", "yaw", worst_yaw, 2.0, "s", how);
  report.at_most("time to 95 %", "pitch", worst_pitch, 60.0, "s", how);
  report.add(std::move(table));
}

}  // namespace boresight::bench
