#include "services/boresight/fit_evidence/scores.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::fit_evidence {

double squared_error(double p, bool is_real) {
  const double error = p - (is_real ? 1.0 : 0.0);
  return error * error;
}

double log_loss(double p, bool is_real) {
  constexpr double kLeast = 1e-4;
  const double clamped = std::clamp(p, kLeast, 1.0 - kLeast);
  return -std::log(is_real ? clamped : 1.0 - clamped);
}

void Scores::add(std::span<const LabelledEvidence> detections, const ghosts::EvidenceWeights& weights) {
  for (const LabelledEvidence& each : detections) {
    add(1.0 / (1.0 + std::exp(-ghosts::posterior_log_odds(weights, each.levels))), each.is_real);
  }
}

}  // namespace boresight::fit_evidence
