// Drives that leave an axis unobservable: the estimator must not report that axis as observable.
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

namespace {

using simulator::AlignmentSpec;
using simulator::RoadKind;

struct DegenerateCase {
  const char* name;
  AlignmentSpec (*make)(double duration_s, std::uint64_t seed);
  std::vector<std::size_t> not_observable;  ///< parameters
};

const std::vector<DegenerateCase> kDegenerateCases = {
    {"straight road: vehicle roll",
     [](double duration_s, std::uint64_t seed) { return clean_drive(RoadKind::kStraight, duration_s, seed); },
     {kRoll}},
    {"all reflectors at the horizon: pitch, roll",
     [](double duration_s, std::uint64_t seed) {
       AlignmentSpec spec = clean_drive(RoadKind::kMixed, duration_s, seed);
       spec.elevation = simulator::ElevationKind::kZero;
       return spec;
     },
     {kPitch, kRoll}},
    {"no elevation measured: pitch, roll",
     [](double duration_s, std::uint64_t seed) {
       AlignmentSpec spec = clean_drive(RoadKind::kMixed, duration_s, seed);
       for (auto& radar : spec.radars) radar.measures_elevation = false;
       return spec;
     },
     {kPitch, kRoll}},
    // The signalled speed stays below 5 m/s: the slow drive has 5…11.5 m/s, the signal a third of that.
    {"signalled speed below 5 m/s: anything",
     [](double duration_s, std::uint64_t seed) {
       AlignmentSpec spec = clean_drive(RoadKind::kSlow, duration_s, seed);
       spec.speed_scale = 3.0;
       return spec;
     },
     {kSpeedScale, kRoll, kPitch, kYaw}},
};

}  // namespace

void degenerate(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(6);
  for (const DegenerateCase& one : kDegenerateCases) {
    std::vector<AlignmentSpec> specs;
    for (std::size_t seed = 0; seed < seeds; ++seed) specs.push_back(one.make(options.seconds(120.0), 1700 + seed));
    const auto runs = run_drives(specs, own_method(options.method).make, options);
    double stated = 0.0, all = 0.0;
    for (const Run& run : runs) {
      for (const Snapshot& snapshot : run.snapshots) {
        for (const RadarError& radar : snapshot.radars) {
          for (const std::size_t p : one.not_observable) {
            all += 1.0;
            stated += (radar.observable & kParameterBits[p]) != 0 ? 1.0 : 0.0;
          }
        }
      }
    }
    report.at_most("not observable", std::string(one.name) + " reported as observable", 100.0 * stated / all, 0.0, "%",
                   "share of estimates, one per second; " + std::to_string(seeds) + " seeds of 120 s");
  }
}

}  // namespace boresight::bench
