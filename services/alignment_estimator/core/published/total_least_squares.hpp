// Burza 2025, (26)(27): nonlinear total least squares.
#pragma once

#include "services/alignment_estimator/core/published/published_method.hpp"

namespace boresight::alignment::published {

/// With the SVD of [J, ηR] the step is V_JR·V_RR⁻¹ of the last column of V; the printed minus belongs to the other sign
/// of R. For η ≪ 1 this is η times the least-squares step: η acts as damping and does not weigh the noise of R against
/// that of J. V is computed as the eigenvectors of the 5 × 5 Gram matrix. `parameters`: 2 or 4, the number of
/// parameters with gradients. Zero if there is no solution: V_RR vanishes if a direction is not observable.
[[nodiscard]] Eigen::Vector4d total_least_squares_step(const NormalEquations& equations, int parameters, double rate);

class TotalLeastSquares final : public PublishedMethod {
 public:
  TotalLeastSquares(const VehicleConfig& vehicle, const PublishedConfig& config)
      : PublishedMethod(vehicle, config, 4, 0), rate_(config.total_least_squares_rate) {}

 private:
  [[nodiscard]] Eigen::Vector4d step(const ScanView& scan) override {
    return total_least_squares_step(scan.equations, scan.parameters, rate_);
  }
  double rate_;
};

}  // namespace boresight::alignment::published
