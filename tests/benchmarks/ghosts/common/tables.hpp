// Confusion tables of many drives.
#pragma once

#include <string>
#include <vector>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/ghosts/common/runner.hpp"

namespace boresight::bench {

/// Rows of truth, columns of labels in percent (medians over the drives), and what was left out or not told.
[[nodiscard]] Table confusion_table(const std::string& name, const std::string& caption,
                                    const std::vector<Outcome>& outcomes);

/// Sums over drives.
struct TrackFaults {
  std::size_t ghost_tracks = 0, longest_ghost_track_scans = 0;
  std::size_t object_seconds = 0, lost_object_seconds = 0;
};
[[nodiscard]] TrackFaults track_faults(const std::vector<Outcome>& outcomes);

/// Bars on what is left of ghosts, and of objects, after the tracker: none in any drive.
void judge_tracks(const std::string& group, const std::vector<Outcome>& outcomes, bool judged, const std::string& how,
                  Report& report);

}  // namespace boresight::bench
