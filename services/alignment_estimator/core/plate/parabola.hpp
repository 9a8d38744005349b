// Weighted least squares of a parabola, Burza 2025, §7 (2)–(8).
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

namespace boresight::alignment::plate {

/// A(t) = b₁t² + b₂t + b₃.
struct Parabola {
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of b, if the weights are the inverse variances of a

  [[nodiscard]] double at(double t) const { return (b[0] * t + b[1]) * t + b[2]; }
  [[nodiscard]] bool has_maximum() const { return b[0] < 0.0; }
  [[nodiscard]] double argmax() const { return -b[1] / (2.0 * b[0]); }
  [[nodiscard]] double maximum() const { return b[2] - b[1] * b[1] / (4.0 * b[0]); }
  /// Variance of argmax(), to first order.
  [[nodiscard]] double argmax_variance() const {
    const Eigen::Vector3d gradient(b[1] / (2.0 * b[0] * b[0]), -1.0 / (2.0 * b[0]), 0.0);
    return gradient.dot(covariance * gradient);
  }
};

/// Minimises Σ w (a − A(t))². All three spans have one length; points of weight 0 do not count. False if fewer than
/// three different t have weight.
[[nodiscard]] bool fit_parabola(std::span<const double> t, std::span<const double> a, std::span<const double> weights,
                                Parabola& out);

}  // namespace boresight::alignment::plate
