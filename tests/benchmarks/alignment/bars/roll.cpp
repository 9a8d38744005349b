// Roll about the vehicle's axis after ten minutes in the city: the parameter that converges last.
#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

void roll(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(20);
  std::vector<simulator::AlignmentSpec> specs;
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    specs.push_back(clean_drive(simulator::RoadKind::kCity, options.seconds(600.0), 500 + seed));
  }
  RunOptions run_options;
  run_options.snapshot_period_s = 10.0;
  const auto runs = run_drives(specs, own_method(options.method).make, options, run_options);
  const std::string how = "600 s of city: median over " + std::to_string(seeds) + " seeds of the worst radar";
  const auto front = final_errors(runs, kRoll, {0, 1}), rear = final_errors(runs, kRoll, {2, 3});
  report.at_most("roll", "front radars", median(front) / kRadiansPerDegree, 0.3, "°", how);
  report.at_most("roll", "rear radars", median(rear) / kRadiansPerDegree, 0.7, "°", how);
  for (const bool is_front : {true, false}) {
    Curve curve{"roll",
                "roll about the vehicle's axis: median over seeds of the worst radar, °",
                is_front ? "front" : "rear",
                {}};
    for (std::size_t s = 1; s < runs.front().snapshots.size(); ++s) {
      std::vector<double> errors;
      for (const Run& run : runs) {
        if (s >= run.snapshots.size()) continue;
        errors.push_back(worst_radar(run.snapshots[s], kRoll,
                                     is_front ? std::vector<std::size_t>{0, 1} : std::vector<std::size_t>{2, 3}));
      }
      curve.points.emplace_back(runs.front().snapshots[s].time_s, median(errors) / kRadiansPerDegree);
    }
    report.add(std::move(curve));
  }
}

}  // namespace boresight::bench
