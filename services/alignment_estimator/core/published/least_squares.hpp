// Burza 2025, (24)(25): damped nonlinear least squares, also used for the 1-D reference of the literature.
#pragma once

#include "services/alignment_estimator/core/published/published_method.hpp"

namespace boresight::alignment::published {

/// −η ∘ (JᵀJ + λI)⁻¹ JᵀR; λ > 0. (24) is printed without the transposition of J. A parameter without gradient gets no
/// step.
[[nodiscard]] Eigen::Vector4d least_squares_step(const NormalEquations& equations, double damping,
                                                 const Eigen::Vector4d& rate);

/// All four parameters (`Kind::kLeastSquares`), or k_v and α with β = γ = 0 (`Kind::kAzimuth1d`), for which Burza 2025
/// names no algorithm: the same one is used.
class LeastSquares final : public PublishedMethod {
 public:
  LeastSquares(const VehicleConfig& vehicle, const PublishedConfig& config, bool azimuth_only)
      : PublishedMethod(vehicle, config, azimuth_only ? 2 : 4, 0),
        damping_(config.least_squares_damping),
        rate_(config.least_squares_rate.data()) {}

 private:
  [[nodiscard]] Eigen::Vector4d step(const ScanView& scan) override {
    return least_squares_step(scan.equations, damping_, rate_);
  }
  double damping_;
  Eigen::Vector4d rate_;
};

}  // namespace boresight::alignment::published
