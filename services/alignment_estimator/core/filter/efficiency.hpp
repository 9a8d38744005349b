// Statistical efficiency of a robust loss, estimated from the residuals themselves.
// Equations: docs/algorithms/alignment.md (A15).
#pragma once

#include <algorithm>

#include "services/alignment_estimator/core/filter/scan_sums.hpp"

namespace boresight::alignment {

/// With a loss ψ the covariance of a location is E[ψ²]/E[ψ′]² (Huber 1964), and not 1/E[ψ′] or 1/E[w]. ScanSums
/// computes its information from Σw and its score from Σψ. This class holds sliding means of w, ψ′ and ψ².
class Efficiency {
 public:
  void add(const ScanSums& sums, double elapsed_s) {
    if (!(sums.weights > 0.0)) return;
    const double share = std::min(1.0, elapsed_s / kMemory_s);
    curvature_ += (sums.curvature / sums.weights - curvature_) * share;
    squares_ += (sums.squares / sums.weights - squares_) * share;
  }
  /// Factors of the information and the score of a scan.
  [[nodiscard]] double of_information() const { return slope() * of_score(); }
  [[nodiscard]] double of_score() const { return slope() / std::clamp(squares_, 0.3, 3.0); }

 private:
  [[nodiscard]] double slope() const { return std::clamp(curvature_, 0.2, 1.0); }
  static constexpr double kMemory_s = 5.0;
  // Start values: Gaussian residuals and a Tukey constant of five stds.
  double curvature_ = 0.848, squares_ = 0.691;
};

}  // namespace boresight::alignment
