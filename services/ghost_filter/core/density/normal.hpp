// Normal distributions in one and two dimensions, and over a segment.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "services/ghost_filter/core/density/exponential.hpp"

namespace boresight::ghosts {

[[nodiscard]] inline double square(double x) {
  return x * x;
}

/// In standard deviations, squared: farther out densities are taken for nothing. There they are less than 1e-7 of what
/// they are in the middle.
inline constexpr double kFarthest2 = 32.0;

/// As far along x or y a density with these variances along them is something.
[[nodiscard]] inline double reach_of(const Eigen::Vector2d& variances) {
  return std::sqrt(kFarthest2 * std::max(variances.x(), variances.y()));
}

/// The same along each of them.
[[nodiscard]] inline Eigen::Vector2d reaches_of(const Eigen::Vector2d& variances) {
  return {std::sqrt(kFarthest2 * variances.x()), std::sqrt(kFarthest2 * variances.y())};
}

/// 0 beyond kFarthest2.
[[nodiscard]] inline double gaussian(double residual, double variance) {
  const double chi2 = residual * residual / variance;
  return chi2 > kFarthest2 ? 0.0 : exponential(-0.5 * chi2) / std::sqrt(2.0 * M_PI * variance);
}

/// Standard normal distribution function, by the logistic approximation (to 0.01).
[[nodiscard]] inline double below(double x) {
  constexpr double kFar = 8.0;  // as good as all or nothing
  if (x > kFar) return 1.0;
  if (x < -kFar) return 0.0;
  return 1.0 / (1.0 + exponential(-1.702 * x));
}

[[nodiscard]] inline double gaussian(const Eigen::Vector2d& residual, const Eigen::Matrix2d& covariance) {
  const double determinant = covariance(0, 0) * covariance(1, 1) - covariance(0, 1) * covariance(1, 0);
  if (!(determinant > 0.0)) return 0.0;
  const double chi2 = (covariance(1, 1) * square(residual.x()) - 2.0 * covariance(0, 1) * residual.x() * residual.y() +
                       covariance(0, 0) * square(residual.y())) /
                      determinant;
  return chi2 > kFarthest2 ? 0.0 : exponential(-0.5 * chi2) / (2.0 * M_PI * std::sqrt(determinant));
}

/// v vᵀ, scaled.
[[nodiscard]] inline Eigen::Matrix2d outer(const Eigen::Vector2d& v, double variance) {
  return variance * (v * v.transpose());
}

[[nodiscard]] inline Eigen::Vector2d left_of(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

}  // namespace boresight::ghosts
