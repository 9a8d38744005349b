// Mounting errors of 5° about each axis, and up to 60 % outliers: detections of moving objects and ghosts.
#include "services/common/geometry/angles.hpp"
#include "services/simulator/random.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

void outliers(const Options& options, Report& report) {
  using simulator::RoadKind;
  const std::size_t seeds = options.seeds(40);
  double worst = 100.0;
  Table table{"outliers",
              "share of runs that converge, mounting errors of 5° about each axis",
              {"share of outliers", "city", "motorway", "mixed"},
              {}};
  for (const double share : {0.25, 0.5, 0.6}) {
    std::vector<std::string> row = {fixed(100.0 * share, 0) + " %"};
    for (const RoadKind road : {RoadKind::kCity, RoadKind::kMotorway, RoadKind::kMixed}) {
      std::vector<simulator::AlignmentSpec> specs;
      for (std::size_t seed = 0; seed < seeds; ++seed) {
        simulator::AlignmentSpec spec = clean_drive(road, options.seconds(60.0), 2000 + seed);
        spec.outlier_share = share;
        simulator::Stream stream(spec.seed, "bench 5 degrees");
        const auto five_degrees = [&] { return (stream.uniform() < 0.5 ? -5.0 : 5.0) * kRadiansPerDegree; };
        for (auto& radar : spec.radars) radar.truth = {five_degrees(), five_degrees(), five_degrees()};
        specs.push_back(spec);
      }
      const auto runs = run_drives(specs, own_method(options.method).make, options);
      double captured = 0.0;
      for (const Run& run : runs) {
        const Snapshot& last = run.last();
        captured += worst_radar(last, kYaw) < 0.1 * kRadiansPerDegree &&
                            worst_radar(last, kPitch) < 0.5 * kRadiansPerDegree && worst_radar(last, kSpeedScale) < 1e-3
                        ? 1.0
                        : 0.0;
      }
      const double percent = 100.0 * captured / static_cast<double>(runs.size());
      row.push_back(fixed(percent, 1) + " %");
      if (share == 0.5) worst = std::min(worst, percent);
    }
    table.rows.push_back(row);
  }
  report.at_least("outliers", "runs that converge, 50 % outliers, mounting errors of 5°", worst, 95.0, "%",
                  "worst of 3 road kinds, " + std::to_string(seeds) +
                      " runs each of 60 s; all radars within 0.1° of yaw, 0.5° of pitch, 1e-3 of k_v");
  report.add(std::move(table));
}

}  // namespace boresight::bench
