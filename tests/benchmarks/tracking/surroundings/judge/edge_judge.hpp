// Errors of the road edges of track lists, against the simulated structures.
#pragma once

#include <cstddef>
#include <vector>

#include "interfaces/messages/track_list.hpp"
#include "tests/benchmarks/tracking/surroundings/judge/true_edges.hpp"

namespace boresight::bench::surroundings {

/// Sums of one drive.
struct EdgeFigures {
  std::size_t samples = 0;    ///< places of edges that are at a structure
  double squares_m2 = 0.0;    ///< of their errors
  double normalised = 0.0;    ///< of their errors over the stated variances
  double signed_m = 0.0;      ///< errors outwards
  std::size_t inner = 0;      ///< of the samples: at the structure that is innermost there
  std::size_t elsewhere = 0;  ///< places of edges that are at no structure
  std::size_t wanted = 0;     ///< places of innermost structures, by scan and side
  std::size_t found = 0;      ///< of these: an edge is there
  [[nodiscard]] double rms_m() const;
  [[nodiscard]] double nees() const;
};

/// Judges one list at x = 0, 5, … 30 m. An edge counts from start to end of its detected part. It is at a structure
/// within kNear_m, and then has the error against that one. At a loose row it is
/// neither judged nor false.
void add(const TrackList& list, const std::vector<TrueEdge>& truth, EdgeFigures& figures);

inline constexpr double kNear_m = 1.0, kFarthest_m = 30.0, kWidest_m = 12.0;

}  // namespace boresight::bench::surroundings
