// Size and heading of a track, from the detections over time, and what of it a sensor sees.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "interfaces/messages/track_list.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/clusters.hpp"

namespace boresight::tracking {

/// Which of a box's faces look towards a sensor; signs along the box's axes, 0 for neither.
struct VisibleFaces {
  double end;   ///< +1 the front, −1 the rear
  double side;  ///< +1 the left side, −1 the right one
};

/// Box along the heading. A side that is seen grows quickly to what is seen and shrinks slowly, as one scan sees only
/// some of its reflections; a side that is not seen stays as it is, at the start that of a car.
struct Extent {
  double heading_rad = 0.0;
  double length_m = 4.5;
  double width_m = 1.8;
  double height_m = 0.0;

  [[nodiscard]] VisibleFaces visible_faces(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& sensor_m) const {
    const Eigen::Vector2d at = to_body(sensor_m - centre_m);
    const auto face = [](double coordinate, double half) {
      return std::abs(coordinate) > half ? std::copysign(1.0, coordinate) : 0.0;
    };
    return {face(at.x(), 0.5 * length_m), face(at.y(), 0.5 * width_m)};
  }

  /// Where the mean of the reflections lies, relative to the centre of the box, if the faces that look towards the
  /// sensor reflect evenly along their lengths. Vehicle axes.
  [[nodiscard]] Eigen::Vector2d visible_mean(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& sensor_m) const {
    const VisibleFaces faces = visible_faces(centre_m, sensor_m);
    const double end_share = std::abs(faces.end) * width_m, side_share = std::abs(faces.side) * length_m;
    if (end_share + side_share <= 0.0) return {0.0, 0.0};
    const Eigen::Vector2d body(0.5 * faces.end * length_m * end_share, 0.5 * faces.side * width_m * side_share);
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    return Eigen::Vector2d(c * body.x() - s * body.y(), s * body.x() + c * body.y()) / (end_share + side_share);
  }

  /// `velocity` over ground in vehicle axes sets the heading if it is fast enough to have a direction.
  void update(const Cluster& cluster, const Eigen::Vector2d& centre_m, const Eigen::Vector2d& velocity_mps,
              const Eigen::Vector2d& sensor_m, bool has_elevation) {
    constexpr double kMinSpeed_mps = 1.0;
    // The velocity across the line of sight is noisy, and where the centre is taken to be depends on the heading: it
    // follows the course over some ten updates, or one would excite the other.
    constexpr double kCourseGain = 0.1;
    if (velocity_mps.norm() > kMinSpeed_mps) {
      const double course_rad = std::atan2(velocity_mps.y(), velocity_mps.x());
      heading_rad = geometry::wrap_angle(heading_rad + kCourseGain * geometry::wrap_angle(course_rad - heading_rad));
    }
    const std::size_t n = std::min<std::size_t>(cluster.number_of_detections, cluster.outline.size());
    Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d p = to_body(cluster.outline[i]);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const VisibleFaces faces = visible_faces(centre_m, sensor_m);
    follow(length_m, high.x() - low.x(), faces.side != 0.0, 0.5, 20.0);
    follow(width_m, high.y() - low.y(), faces.end != 0.0, 0.5, 4.0);
    if (has_elevation) follow(height_m, cluster.z_max_m, true, 0.0, 5.0);
  }

  [[nodiscard]] ObjectClass object_class() const {
    if (length_m > 6.5) return ObjectClass::kTruck;
    if (length_m > 2.6) return ObjectClass::kCar;
    return length_m > 1.4 ? ObjectClass::kTwoWheeler : ObjectClass::kUnknown;
  }

  /// Whether a point lies in the box, made larger by a margin on every side.
  [[nodiscard]] bool contains(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& point_m, double margin_m) const {
    const Eigen::Vector2d at = to_body(point_m - centre_m);
    return std::abs(at.x()) < 0.5 * length_m + margin_m && std::abs(at.y()) < 0.5 * width_m + margin_m;
  }

 private:
  [[nodiscard]] Eigen::Vector2d to_body(const Eigen::Vector2d& v) const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    return {c * v.x() + s * v.y(), -s * v.x() + c * v.y()};
  }
  static void follow(double& value, double seen, bool visible, double low, double high) {
    if (seen <= value && !visible) return;
    const double gain = seen > value ? 0.3 : 0.02;
    value = std::clamp(value + gain * (seen - value), low, high);
  }
};

}  // namespace boresight::tracking
