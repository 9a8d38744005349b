// Proper scores of the probability that a moving detection is real.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "services/boresight/fit_evidence/fit_weights.hpp"

namespace boresight::fit_evidence {

/// (p − outcome)²: its mean is the Brier score (Brier 1950).
[[nodiscard]] double squared_error(double p, bool is_real);
/// −ln of the probability of the outcome. Probabilities count as at least 1e-4, and at most 1 less that.
[[nodiscard]] double log_loss(double p, bool is_real);

/// Mean scores over detections; NaN without any.
class Scores {
 public:
  void add(double p, bool is_real) {
    squared_errors_ += squared_error(p, is_real);
    log_losses_ += fit_evidence::log_loss(p, is_real);
    ++detections_;
  }
  /// By the weights.
  void add(std::span<const LabelledEvidence> detections, const ghosts::EvidenceWeights& weights);

  [[nodiscard]] double brier() const { return mean(squared_errors_); }
  [[nodiscard]] double log_loss() const { return mean(log_losses_); }
  [[nodiscard]] std::size_t detections() const { return detections_; }

 private:
  [[nodiscard]] double mean(double sum) const {
    return detections_ == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(detections_);
  }
  double squared_errors_ = 0.0, log_losses_ = 0.0;
  std::size_t detections_ = 0;
};

}  // namespace boresight::fit_evidence
