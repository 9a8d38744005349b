// Statistics over the drives of many seeds.
#pragma once

#include <vector>

#include "tests/benchmarks/ghosts/common/runner.hpp"

namespace boresight::bench {

/// Over seeds; those without any detection of the truth have no part in it. NaN if none has.
struct Percent {
  double median = 0.0, worst = 0.0;  ///< worst: the lowest
};
[[nodiscard]] Percent percent_told(const std::vector<Outcome>& outcomes, Provenance truth, Provenance label);
[[nodiscard]] Percent percent_told_ghost(const std::vector<Outcome>& outcomes, Provenance truth);
/// Told to be anything but moving.
[[nodiscard]] Percent percent_not_moving(const std::vector<Outcome>& outcomes, Provenance truth);
/// Of all detections of the truth, that the corrector left out before the filter.
[[nodiscard]] Percent percent_left_out(const std::vector<Outcome>& outcomes, Provenance truth);
/// Of the type-1 ghosts, those apart from their object's box; and of those, told to be ghosts of either type.
[[nodiscard]] Percent percent_apart(const std::vector<Outcome>& outcomes);
[[nodiscard]] Percent percent_apart_told(const std::vector<Outcome>& outcomes);
/// Median number of detections, those left out included.
[[nodiscard]] double median_count(const std::vector<Outcome>& outcomes, Provenance truth);

/// Sums over drives.
struct TrackFaults {
  std::size_t ghost_tracks = 0, longest_ghost_track_scans = 0, other_tracks = 0;
  std::size_t object_seconds = 0, lost_seconds = 0, lost_though_told_seconds = 0, gained_seconds = 0;
  std::size_t objects = 0, lost_objects = 0;  ///< with a second that perfect labels have; lost for over half of those
  /// Of the ghost tracks, those that last five steps of Le Ba Thanh 2023, in each of which all radars scan once.
  static constexpr double kFiveSteps_s = 0.5;
  std::size_t lasting_ghost_tracks = 0;
  LostByChance lost_by_chance;
  TrackFaults& operator+=(const TrackFaults& other);
};
[[nodiscard]] TrackFaults track_faults(const std::vector<Outcome>& outcomes);

}  // namespace boresight::bench
