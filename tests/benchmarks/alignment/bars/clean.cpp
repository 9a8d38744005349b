// Two minutes of clean drives on every kind of road.
#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

void clean(const Options& options, Report& report) {
  using simulator::RoadKind;
  const std::size_t seeds = options.seeds(24);
  Table table{"clean",
              "clean drives of 120 s: median over seeds of the worst radar (95 % quantile)",
              {"road", "k_v", "yaw °", "pitch °", "roll °"},
              {}};
  double worst[4] = {0.0, 0.0, 0.0, 0.0};
  for (const RoadKind road :
       {RoadKind::kCity, RoadKind::kMotorway, RoadKind::kMixed, RoadKind::kStraight, RoadKind::kSlow}) {
    std::vector<simulator::AlignmentSpec> specs;
    for (std::size_t seed = 0; seed < seeds; ++seed) {
      specs.push_back(clean_drive(road, options.seconds(120.0), 100 + seed));
    }
    const auto runs = run_drives(specs, own_method(options.method).make, options);
    std::vector<std::string> row = {name_of(road)};
    for (const int parameter : {kSpeedScale, kYaw, kPitch, kRoll}) {
      const auto errors = final_errors(runs, parameter);
      const double unit = parameter == kSpeedScale ? 1.0 : kRadiansPerDegree;
      worst[parameter] = std::max(worst[parameter], median(errors) / unit);
      row.push_back(number(median(errors) / unit) + " (" + number(quantile(errors, 0.95) / unit) + ")");
    }
    table.rows.push_back(row);
  }
  const std::string how =
      "120 s: median over " + std::to_string(seeds) + " seeds of the worst radar; worst of 5 road kinds";
  report.at_most("clean", "k_v", worst[kSpeedScale], 5e-5, "", how);
  report.at_most("clean", "yaw", worst[kYaw], 0.01, "°", how);
  report.at_most("clean", "pitch", worst[kPitch], 0.03, "°", how);
  report.add(std::move(table));
}

}  // namespace boresight::bench
