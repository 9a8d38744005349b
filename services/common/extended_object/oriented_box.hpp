// A rectangle in the plane: the outline of an object, and its geometry as a sensor needs it.
//
// Box axes: origin at the centre, x along the length towards the heading, y to the left across the width.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

namespace boresight::extended_object {

/// The faces of a box that a sensor looks at from outside. At most two are true; none from inside.
struct VisibleFaces {
  bool front = false, rear = false, left = false, right = false;
};

struct OrientedBox {
  Eigen::Vector2d centre_m{0.0, 0.0};
  double heading_rad = 0.0;  ///< direction of the length axis, counter-clockwise
  double length_m = 0.0;
  double width_m = 0.0;

  [[nodiscard]] Eigen::Vector2d half_size_m() const { return {0.5 * length_m, 0.5 * width_m}; }

  /// Rotation of a vector into box axes; its transpose rotates back.
  [[nodiscard]] Eigen::Matrix2d rotation_to_box() const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    Eigen::Matrix2d rotation;
    rotation << c, s, -s, c;
    return rotation;
  }

  [[nodiscard]] Eigen::Vector2d to_box(const Eigen::Vector2d& point_m) const {
    return rotation_to_box() * (point_m - centre_m);
  }
  [[nodiscard]] Eigen::Vector2d from_box(const Eigen::Vector2d& point_box_m) const {
    return centre_m + rotation_to_box().transpose() * point_box_m;
  }

  /// Whether a point lies within the box grown by `margin_m` on every side; a negative margin shrinks it.
  [[nodiscard]] bool contains(const Eigen::Vector2d& point_m, double margin_m = 0.0) const {
    const Eigen::Vector2d outside = to_box(point_m).cwiseAbs() - half_size_m();
    return outside.maxCoeff() <= margin_m;
  }

  /// The point of the filled box that is nearest to `point_m`, which is the point itself if it is inside.
  [[nodiscard]] Eigen::Vector2d nearest_point(const Eigen::Vector2d& point_m) const {
    const Eigen::Vector2d half = half_size_m();
    return from_box(to_box(point_m).cwiseMax(-half).cwiseMin(half));
  }

  /// Distance to the filled box, in m; 0 inside.
  [[nodiscard]] double distance_m(const Eigen::Vector2d& point_m) const {
    return (to_box(point_m).cwiseAbs() - half_size_m()).cwiseMax(0.0).norm();
  }

  /// Depth below the nearest face, in m; outside it is the negative distance.
  [[nodiscard]] double depth_m(const Eigen::Vector2d& point_m) const {
    const Eigen::Vector2d inside = half_size_m() - to_box(point_m).cwiseAbs();
    return inside.minCoeff() >= 0.0 ? inside.minCoeff() : -inside.cwiseMin(0.0).norm();
  }

  /// Front left, rear left, rear right, front right: counter-clockwise.
  [[nodiscard]] std::array<Eigen::Vector2d, 4> corners() const {
    const Eigen::Vector2d half = half_size_m();
    return {from_box(half), from_box({-half.x(), half.y()}), from_box(-half), from_box({half.x(), -half.y()})};
  }

  /// Half of the box's projection onto a unit vector, in m: the support function about the centre.
  [[nodiscard]] double half_extent_along_m(const Eigen::Vector2d& direction) const {
    return (rotation_to_box() * direction).cwiseAbs().dot(half_size_m());
  }

  [[nodiscard]] VisibleFaces visible_faces(const Eigen::Vector2d& sensor_m) const {
    const Eigen::Vector2d sensor = to_box(sensor_m), half = half_size_m();
    return {sensor.x() > half.x(), sensor.x() < -half.x(), sensor.y() > half.y(), sensor.y() < -half.y()};
  }
};

}  // namespace boresight::extended_object
