// Weights of the evidence from labelled detections: logistic regression with a ridge prior, by Newton's method.
#pragma once

#include <cstddef>
#include <vector>

#include "services/ghost_filter/core/evidence/levels.hpp"
#include "services/ghost_filter/core/evidence/weights.hpp"

namespace boresight::fit_evidence {

/// The evidence of a detection, and whether it is a direct echo of a moving object.
struct LabelledEvidence {
  ghosts::Levels levels;
  bool is_real = false;
};

struct FitConfig {
  double ridge = 1.0;              ///< weight of the prior: 1 / variance of a weight
  double doubted_log_odds = -3.0;  ///< prior mean of a detection that the sensor calls invalid, where drives have none
};

/// Maximum of the posterior of (G1), by all detections, and of (G2) and (G14), by those with known tracks. Without
/// detections all weights keep their prior.
[[nodiscard]] ghosts::EvidenceWeights fit_weights(const std::vector<LabelledEvidence>& detections,
                                                  const FitConfig& config);

}  // namespace boresight::fit_evidence
