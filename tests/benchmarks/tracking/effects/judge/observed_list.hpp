// Figures of a recording of one moving object, without truth: which tracks there are, and when.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tests/benchmarks/tracking/drives/judge/scene.hpp"
#include "tests/benchmarks/tracking/drives/judge/threshold.hpp"

namespace boresight::bench::tracking {

/// A track list beside the detections of its scan.
struct ObservedList {
  double t_s = 0.0;
  std::vector<ListedTrack> tracks;
  std::vector<Eigen::Vector2d> moving_m;  ///< detections that move over ground, whatever their origin by the filter
};

/// A detection that is faster than this moves: the noise of the recordings is below, every object above. Choice.
inline constexpr double kMoves_mps = 0.5;
/// A track at most so far from a detection that moves is at the object. Choice: half a truck.
inline constexpr double kAtObject_m = 5.0;

/// From the first detection that moves to the first list from then on with a counting track at such a detection, s.
/// Infinite: never.
[[nodiscard]] double delay_s(const std::vector<ObservedList>& lists, const Rule& rule);

/// Time with two or more counting tracks at once, s: one of them is no object.
struct SecondTracks {
  double total_s = 0.0, longest_s = 0.0;
};
[[nodiscard]] SecondTracks second_tracks(const std::vector<ObservedList>& lists, const Rule& rule);

/// Share of the lists from the first detection that moves on that have a counting track, %. NaN without such lists.
[[nodiscard]] double tracked_percent(const std::vector<ObservedList>& lists, const Rule& rule);

}  // namespace boresight::bench::tracking
