// How much a robust loss knows of a location, as the residuals themselves say.
#pragma once

#include <algorithm>

#include "services/alignment_estimator/core/filter/scan_sums.hpp"

namespace boresight::alignment {

/// With a loss ψ the covariance of a location is E[ψ²]/E[ψ′]² (Huber 1964), neither 1/E[ψ′] nor 1/E[w]: ScanSums'
/// information is of Σw and its score of Σψ. Sliding means of the three.
class Efficiency {
 public:
  void add(const ScanSums& sums, double elapsed_s) {
    if (!(sums.weights > 0.0)) return;
    const double share = std::min(1.0, elapsed_s / kMemory_s);
    curvature_ += (sums.curvature / sums.weights - curvature_) * share;
    squares_ += (sums.squares / sums.weights - squares_) * share;
  }
  /// Factors by which the information and the score of a scan count.
  [[nodiscard]] double of_information() const { return slope() * of_score(); }
  [[nodiscard]] double of_score() const { return slope() / std::clamp(squares_, 0.3, 3.0); }

 private:
  [[nodiscard]] double slope() const { return std::clamp(curvature_, 0.2, 1.0); }
  static constexpr double kMemory_s = 5.0;
  // Those of Gaussian residuals at five stds.
  double curvature_ = 0.848, squares_ = 0.691;
};

}  // namespace boresight::alignment
