// The whole chain over a simulated drive, with a second tracker that gets the true origins of the detections.
#pragma once

#include <filesystem>
#include <vector>

#include "services/common/runtime/options.hpp"

namespace boresight::bench::tracking {

/// CPU time of both trackers in each scan, ms. They run in the same process, in turns.
struct StepTimes {
  std::vector<double> filtered_ms;  ///< with the origins of the ghost filter
  std::vector<double> perfect_ms;   ///< with the true origins
};

/// `recordings` and `truth` are of one drive. Writes scans.csv, tracks.csv, run.json and the times of the second
/// tracker into `out`. Throws std::runtime_error, also if a scan has no truth.
void run_with_true_origins(const std::vector<std::filesystem::path>& recordings, const std::filesystem::path& truth,
                           const runtime::Configuration& configuration, const std::filesystem::path& out);

/// Throws score::InputError.
[[nodiscard]] StepTimes read_step_times(const std::filesystem::path& run);

}  // namespace boresight::bench::tracking
