// One method on many drives, and statistics over the runs.
#pragma once

#include <vector>

#include "tests/benchmarks/alignment/common/runner.hpp"
#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/common/parallel.hpp"

namespace boresight::bench {

[[nodiscard]] inline std::vector<Run> run_drives(const std::vector<simulator::AlignmentSpec>& specs,
                                                 const MakeMethod& make, const Options& options,
                                                 const RunOptions& run_options = {}) {
  std::vector<Run> runs(specs.size());
  parallel_for(specs.size(), options.jobs, [&](std::size_t i) { runs[i] = run_drive(specs[i], make, run_options); });
  return runs;
}

/// Largest absolute error of a parameter over some of the radars (all, if none are named).
[[nodiscard]] inline double worst_radar(const Snapshot& snapshot, int parameter, std::vector<std::size_t> radars = {}) {
  if (radars.empty()) {
    for (std::size_t r = 0; r < snapshot.radars.size(); ++r) radars.push_back(r);
  }
  double worst = 0.0;
  for (const std::size_t r : radars) worst = std::max(worst, std::abs(snapshot.radars[r].error(parameter)));
  return worst;
}

/// The final error of the worst radar of each run.
[[nodiscard]] inline std::vector<double> final_errors(const std::vector<Run>& runs, int parameter,
                                                      const std::vector<std::size_t>& radars = {}) {
  std::vector<double> errors;
  for (const Run& run : runs) errors.push_back(worst_radar(run.last(), parameter, radars));
  return errors;
}

}  // namespace boresight::bench
