// The threshold of the score at which a tracker has a wanted number of false tracks.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace boresight::bench::tracking {

/// Which tracks of a list count.
struct Rule {
  float least_score = -std::numeric_limits<float>::infinity();
  bool confirmed_only = false;
  [[nodiscard]] bool counts(float score, bool confirmed) const {
    return score >= least_score && (!confirmed_only || confirmed);
  }
};

/// Scores may be equal, so that no threshold gives the wanted number. Two thresholds are then mixed: the lower one
/// counts with its weight, the higher one with the rest. Shares between them lie on the straight line.
struct OperatingPoint {
  Rule lower, higher;
  double weight_of_lower = 1.0;
  double false_tracks = 0.0;  ///< reached: mean number in a list
};

/// `false_scores`: of all false tracks of all lists. If they are fewer than wanted, every track counts.
[[nodiscard]] OperatingPoint operating_point(std::vector<float> false_scores, std::size_t lists,
                                             double wanted_false_tracks);

}  // namespace boresight::bench::tracking
