// Values of the plane as Eigen has them, and turns into other axes.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "services/tracker/core/ggiw/planar.hpp"

namespace boresight::tracking {

/// From the axes of a box with that heading to those that the heading is measured in.
[[nodiscard]] inline Eigen::Matrix2d rotation(double heading_rad) {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  Eigen::Matrix2d r;
  r << c, -s, s, c;
  return r;
}

[[nodiscard]] inline Eigen::Matrix2d eigen(const Symmetric2<double>& s) {
  Eigen::Matrix2d m;
  m << s.xx, s.xy, s.xy, s.yy;
  return m;
}

[[nodiscard]] inline Eigen::Vector2d eigen(const Vector2<double>& v) {
  return {v.x, v.y};
}

/// v vᵀ
[[nodiscard]] inline Eigen::Matrix2d squared(const Eigen::Vector2d& v) {
  return v * v.transpose();
}

}  // namespace boresight::tracking
