// Intersections of segments, rays and ellipses in the plane.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Core>

namespace boresight::geometry {

/// Intersection of the segments a→b and c→d as a share of a→b, 0 … 1; nothing if they do not cross or are parallel.
[[nodiscard]] inline std::optional<double> crossing(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                                    const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  const Eigen::Vector2d r = b - a, s = d - c;
  const double denominator = r.x() * s.y() - r.y() * s.x();
  if (std::abs(denominator) < 1e-12) return std::nullopt;
  const Eigen::Vector2d q = c - a;
  const double along_r = (q.x() * s.y() - q.y() * s.x()) / denominator;
  const double along_s = (q.x() * r.y() - q.y() * r.x()) / denominator;
  if (along_r < 0.0 || along_r > 1.0 || along_s < 0.0 || along_s > 1.0) return std::nullopt;
  return along_r;
}

struct Ellipse {
  Eigen::Vector2d centre_m;
  double heading_rad;  ///< of the first axis
  double half_length_m;
  double half_width_m;
};

/// The part of the ray within an ellipse, as distances from `origin` along the unit vector `direction`; nothing if the
/// ray misses the ellipse or the ellipse lies behind the origin.
struct Stretch {
  double enter_m;
  double leave_m;
};
[[nodiscard]] inline std::optional<Stretch> stretch_within(const Ellipse& ellipse, const Eigen::Vector2d& origin,
                                                           const Eigen::Vector2d& direction) {
  const double c = std::cos(ellipse.heading_rad), s = std::sin(ellipse.heading_rad);
  // In coordinates in which the ellipse is a unit circle.
  const auto scale = [&](const Eigen::Vector2d& v) {
    return Eigen::Vector2d((c * v.x() + s * v.y()) / ellipse.half_length_m,
                           (-s * v.x() + c * v.y()) / ellipse.half_width_m);
  };
  const Eigen::Vector2d o = scale(origin - ellipse.centre_m), d = scale(direction);
  const double a = d.squaredNorm(), b = o.dot(d), q = o.squaredNorm() - 1.0;
  const double discriminant = b * b - a * q;
  if (discriminant <= 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  const Stretch stretch{(-b - root) / a, (-b + root) / a};
  if (stretch.leave_m <= 0.0) return std::nullopt;
  return stretch;
}

[[nodiscard]] inline bool contains(const Ellipse& ellipse, const Eigen::Vector2d& point) {
  const double c = std::cos(ellipse.heading_rad), s = std::sin(ellipse.heading_rad);
  const Eigen::Vector2d v = point - ellipse.centre_m;
  const double x = (c * v.x() + s * v.y()) / ellipse.half_length_m;
  const double y = (-s * v.x() + c * v.y()) / ellipse.half_width_m;
  return x * x + y * y <= 1.0;
}

}  // namespace boresight::geometry
