// A straight line or an arc in the plane, in one parametrisation: through `origin_m` along `tangent`, with a curvature
// that may be zero. Distances are exact for both, so that a least-squares fit of them is total least squares.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

namespace boresight::ghosts {

struct Curve {
  static constexpr double kSmall_rad = 0.5;  ///< below this the series are good to 1e-7, and far cheaper
  Eigen::Vector2d origin_m{0.0, 0.0};
  Eigen::Vector2d tangent{1.0, 0.0};  ///< unit
  double curvature_per_m = 0.0;       ///< positive: bends to the left of the tangent

  [[nodiscard]] Eigen::Vector2d normal() const { return {-tangent.y(), tangent.x()}; }
  /// Along the tangent and across it, from the origin.
  [[nodiscard]] Eigen::Vector2d local(const Eigen::Vector2d& p) const { return to_local(p - origin_m); }
  /// Signed distance of a point given in local coordinates, positive on the left. Pratt's form, which has no pole at
  /// curvature 0.
  [[nodiscard]] double distance_of_local(const Eigen::Vector2d& q) const {
    const double a = q.y() - 0.5 * curvature_per_m * q.squaredNorm();
    return 2.0 * a / (1.0 + std::sqrt(std::max(0.0, 1.0 - 2.0 * curvature_per_m * a)));
  }
  [[nodiscard]] double distance(const Eigen::Vector2d& p) const { return distance_of_local(local(p)); }
  /// Whether a point given in local coordinates lies nearer to the curve than `most_m`, which is less than its radius.
  /// It takes no root and no division: a = d − curvature·d²/2 grows with the distance d.
  [[nodiscard]] bool is_within(const Eigen::Vector2d& q, double most_m) const {
    const double a = q.y() - 0.5 * curvature_per_m * q.squaredNorm();
    return std::abs(a + 0.5 * curvature_per_m * most_m * most_m) < most_m;
  }
  /// Arc length from the origin of the foot of a point given in local coordinates.
  [[nodiscard]] double arc_of_local(const Eigen::Vector2d& q) const {
    const double ahead = q.x() / (1.0 - curvature_per_m * q.y());
    const double tangent_of = curvature_per_m * ahead, square = tangent_of * tangent_of;
    // The usual case, to 1e-6 of the arc length.
    if (square < 0.04 && ahead * q.x() >= 0.0)
      return ahead * (1.0 - square * (1.0 / 3.0 - square * (0.2 - square / 7.0)));
    return std::atan2(curvature_per_m * q.x(), 1.0 - curvature_per_m * q.y()) / curvature_per_m;
  }
  [[nodiscard]] double arc(const Eigen::Vector2d& p) const { return arc_of_local(local(p)); }
  /// Along the tangent and across it; the unit tangent there in the same axes.
  [[nodiscard]] Eigen::Vector2d local_at(double arc_m) const {
    const double angle = curvature_per_m * arc_m;
    if (std::abs(angle) < kSmall_rad) {
      const double square = angle * angle;
      return {arc_m * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0))),
              arc_m * 0.5 * angle * (1.0 - square / 12.0 * (1.0 - square / 30.0))};
    }
    const double half = 0.5 * angle, chord_m = arc_m * std::sin(half) / half;
    return {chord_m * std::cos(half), chord_m * std::sin(half)};
  }
  [[nodiscard]] Eigen::Vector2d local_tangent_at(double arc_m) const {
    const double angle = curvature_per_m * arc_m;
    if (std::abs(angle) < kSmall_rad) {
      const double square = angle * angle;
      return {1.0 - 0.5 * square * (1.0 - square / 12.0 * (1.0 - square / 30.0)),
              angle * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)))};
    }
    return {std::cos(angle), std::sin(angle)};
  }
  /// A vector in local axes, and one given in them.
  [[nodiscard]] Eigen::Vector2d to_local(const Eigen::Vector2d& v) const {
    return {v.dot(tangent), tangent.x() * v.y() - tangent.y() * v.x()};
  }
  [[nodiscard]] Eigen::Vector2d from_local(const Eigen::Vector2d& v) const {
    return {v.x() * tangent.x() - v.y() * tangent.y(), v.x() * tangent.y() + v.y() * tangent.x()};
  }
  [[nodiscard]] Eigen::Vector2d at(double arc_m) const { return origin_m + from_local(local_at(arc_m)); }
  [[nodiscard]] Eigen::Vector2d tangent_at(double arc_m) const { return from_local(local_tangent_at(arc_m)); }
  /// The same curve with its origin moved along it.
  [[nodiscard]] Curve moved(double arc_m) const { return {at(arc_m), tangent_at(arc_m), curvature_per_m}; }
  /// After the change that a fit found: shift along the normal, turn, and change of curvature.
  [[nodiscard]] Curve changed(const Eigen::Vector3d& change) const {
    const double c = std::cos(change(1)), s = std::sin(change(1));
    return {origin_m + change(0) * normal(), (c * tangent + s * normal()).normalized(), curvature_per_m + change(2)};
  }

  /// Distances along a ray (unit `direction`) at which it crosses the curve, the nearer one first; those that do not
  /// exist or lie behind are negative.
  [[nodiscard]] std::array<double, 2> crossings(const Eigen::Vector2d& from, const Eigen::Vector2d& direction) const {
    const Eigen::Vector2d q = local(from);
    const Eigen::Vector2d d = to_local(direction);
    const double a = -0.5 * curvature_per_m;
    const double b = d.y() - curvature_per_m * q.dot(d);
    const double c = q.y() - 0.5 * curvature_per_m * q.squaredNorm();
    const double discriminant = b * b - 4.0 * a * c;
    std::array<double, 2> found{-1.0, -1.0};
    if (discriminant < 0.0 || (a == 0.0 && b == 0.0)) return found;
    // The two forms of the root that do not cancel: one holds for a straight line, too.
    const double h = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    if (h != 0.0) found[0] = c / h;
    if (a != 0.0) found[1] = h / a;
    if (found[0] < 0.0 || (found[1] >= 0.0 && found[1] < found[0])) std::swap(found[0], found[1]);
    return found;
  }
};

}  // namespace boresight::ghosts
