// Additive log-odds of the evidence.
//
//     (G1)   ln P/(1−P) = c + Σ_k w_k(level_k),
//
// by the evidence of the scans alone, and with tracks by that of their mirror images, too, and other weights:
//
//     (G2)   ln P/(1−P) = c' + Σ_k w'_k(level_k) + (1 − s)·u(level of the tracks) + s·v(level of the tracks),
//
// s: how surely the object exists. The weights are fitted to labelled drives of a radar. Sums of evidence saturate
// because each level does.
#pragma once

#include <array>
#include <cmath>

#include "services/ghost_filter/core/evidence/levels.hpp"

namespace boresight::ghosts {

struct LevelWeights {
  double constant = 0.0;
  std::array<std::array<double, kMostLevels>, kEvidences> of{};
};

/// Of one radar, as its profile states them. All zero: the evidence says nothing.
struct EvidenceWeights {
  double prior_log_odds = 0.0;  ///< of the drives that the weights were fitted on: (G1) less this is a likelihood ratio
  LevelWeights alone;
  LevelWeights ratio;  ///< for the tracker: tracks enter by their mirror images only; without the prior
  LevelWeights with_tracks;
  std::array<double, kTrackLevels> track_unsure{}, track_sure{};
};

/// Sum over the first `kinds` kinds of evidence.
[[nodiscard]] inline double log_odds(const LevelWeights& weights, const Levels& levels, std::size_t kinds) {
  double sum = weights.constant;
  for (std::size_t k = 0; k < kinds; ++k) sum += weights.of[k][levels.of[k]];
  return sum;
}
/// Equation (G1).
[[nodiscard]] inline double log_odds_alone(const EvidenceWeights& weights, const Levels& levels) {
  return log_odds(weights.alone, levels, kScanEvidences);
}
/// ln p(evidence | direct echo of a moving object) / p(evidence | false): (G14), or (G1) without the prior where no
/// tracks are known.
[[nodiscard]] inline double log_likelihood_ratio(const EvidenceWeights& weights, const Levels& levels) {
  if (!levels.has_tracks) return log_odds_alone(weights, levels) - weights.prior_log_odds;
  return log_odds(weights.ratio, levels, kEvidences);
}
/// Equation (G2), or (G1) where no tracks are known.
[[nodiscard]] inline double posterior_log_odds(const EvidenceWeights& weights, const Levels& levels) {
  if (!levels.has_tracks) return log_odds_alone(weights, levels);
  const auto sure = static_cast<double>(levels.sure);
  return log_odds(weights.with_tracks, levels, kEvidences) + (1.0 - sure) * weights.track_unsure[levels.track] +
         sure * weights.track_sure[levels.track];
}

}  // namespace boresight::ghosts
