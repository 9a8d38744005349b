// Burza 2025, (22)(23): steepest descent.
#pragma once

#include "services/alignment_estimator/core/published/published_method.hpp"

namespace boresight::alignment::published {

/// −η ∘ (JᵀR) / N. It diverges if η times the mean square of a gradient exceeds 2: with the published η_α = 1e-3 at a
/// speed of about 60 m/s.
[[nodiscard]] inline Eigen::Vector4d steepest_descent_step(const NormalEquations& equations,
                                                           const Eigen::Vector4d& rate) {
  if (equations.count == 0) return Eigen::Vector4d::Zero();
  return -rate.cwiseProduct(equations.jtr) / static_cast<double>(equations.count);
}

class SteepestDescent final : public PublishedMethod {
 public:
  SteepestDescent(const VehicleConfig& vehicle, const PublishedConfig& config)
      : PublishedMethod(vehicle, config, 4, 0), rate_(config.steepest_descent_rate.data()) {}

 private:
  [[nodiscard]] Eigen::Vector4d step(const ScanView& scan) override {
    return steepest_descent_step(scan.equations, rate_);
  }
  Eigen::Vector4d rate_;
};

}  // namespace boresight::alignment::published
