// Sums over the detections of a scan, the input of the gradient methods.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "services/alignment_estimator/core/published/planar_model.hpp"

namespace boresight::alignment::published {

/// Sums over N detections with residuals R = model − measured (m/s) and rows of J = ∂ṙ/∂b, b = (k_v, α, β, γ).
struct NormalEquations {
  Eigen::Matrix4d jtj = Eigen::Matrix4d::Zero();
  Eigen::Vector4d jtr = Eigen::Vector4d::Zero();
  double rtr = 0.0;
  std::size_t count = 0;

  void add(const Eigen::Vector4d& gradient, double residual) {
    jtj.noalias() += gradient * gradient.transpose();
    jtr += gradient * residual;
    rtr += residual * residual;
    ++count;
  }
};

}  // namespace boresight::alignment::published
