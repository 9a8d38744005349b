// Statistics over the drives of many seeds.
#pragma once

#include <vector>

#include "tests/benchmarks/ghosts/common/runner.hpp"

namespace boresight::bench {

/// Over seeds; seeds without any detection of the truth are not counted. NaN if no seed has one.
struct Percent {
  double median = 0.0, worst = 0.0;  ///< worst: the lowest
};
[[nodiscard]] Percent percent_classified(const std::vector<Outcome>& outcomes, Provenance truth, Provenance label);
[[nodiscard]] Percent percent_classified_ghost(const std::vector<Outcome>& outcomes, Provenance truth);
/// Classified as anything but moving.
[[nodiscard]] Percent percent_not_moving(const std::vector<Outcome>& outcomes, Provenance truth);
/// Of the detections classified as moving, those that are direct echoes of moving objects.
[[nodiscard]] Percent percent_truly_moving(const std::vector<Outcome>& outcomes);
/// Of all detections of the truth: rejected by the corrector before the filter.
[[nodiscard]] Percent percent_rejected(const std::vector<Outcome>& outcomes, Provenance truth);
/// Of the type-1 ghosts, those apart from their object's box; and of these, classified as ghost of either type.
[[nodiscard]] Percent percent_apart(const std::vector<Outcome>& outcomes);
[[nodiscard]] Percent percent_apart_classified_ghost(const std::vector<Outcome>& outcomes);
/// Median number of detections, including those rejected by the corrector.
[[nodiscard]] double median_count(const std::vector<Outcome>& outcomes, Provenance truth);

/// Sums over drives.
struct TrackFaults {
  std::size_t ghost_tracks = 0, longest_ghost_track_scans = 0, other_tracks = 0;
  std::size_t object_seconds = 0, lost_seconds = 0, lost_though_correct_seconds = 0, gained_seconds = 0;
  std::size_t objects = 0, lost_objects = 0;  ///< held in some second with perfect labels; lost in over half of these
  /// Of the ghost tracks, those that last at least five time steps of Le Ba Thanh's scene, in each of which all radars
  /// scan once.
  static constexpr double kFiveSteps_s = 0.5;
  std::size_t lasting_ghost_tracks = 0;
  LostByChance lost_by_chance;
  TrackFaults& operator+=(const TrackFaults& other);
};
[[nodiscard]] TrackFaults track_faults(const std::vector<Outcome>& outcomes);

}  // namespace boresight::bench
