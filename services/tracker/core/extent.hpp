// Size and heading of a track, from the detections over time.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "interfaces/messages/track_list.hpp"
#include "services/tracker/core/clusters.hpp"

namespace boresight::tracking {

/// Box along the heading; grows quickly with what is seen and shrinks slowly, as one scan sees only a part.
struct Extent {
  double heading_rad = 0.0;
  double length_m = 1.0;
  double width_m = 1.0;
  double height_m = 0.0;

  /// `velocity` over ground in vehicle axes sets the heading if it is fast enough to have a direction.
  void update(const Cluster& cluster, const Eigen::Vector2d& velocity_mps, bool has_elevation) {
    constexpr double kMinSpeed_mps = 1.0;
    if (velocity_mps.norm() > kMinSpeed_mps) heading_rad = std::atan2(velocity_mps.y(), velocity_mps.x());
    const Eigen::Vector2d along(std::cos(heading_rad), std::sin(heading_rad)), across(-along.y(), along.x());
    const std::size_t n = std::min<std::size_t>(cluster.number_of_detections, cluster.outline.size());
    double a0 = 1e9, a1 = -1e9, c0 = 1e9, c1 = -1e9;
    for (std::size_t i = 0; i < n; ++i) {
      a0 = std::min(a0, along.dot(cluster.outline[i]));
      a1 = std::max(a1, along.dot(cluster.outline[i]));
      c0 = std::min(c0, across.dot(cluster.outline[i]));
      c1 = std::max(c1, across.dot(cluster.outline[i]));
    }
    follow(length_m, a1 - a0, 0.5, 20.0);
    follow(width_m, c1 - c0, 0.5, 4.0);
    if (has_elevation) follow(height_m, cluster.z_max_m, 0.0, 5.0);
  }

  [[nodiscard]] ObjectClass object_class() const {
    if (length_m > 6.5) return ObjectClass::kTruck;
    if (length_m > 2.6) return ObjectClass::kCar;
    return length_m > 1.4 ? ObjectClass::kTwoWheeler : ObjectClass::kUnknown;
  }

 private:
  static void follow(double& value, double seen, double low, double high) {
    const double gain = seen > value ? 0.3 : 0.02;
    value = std::clamp(value + gain * (seen - value), low, high);
  }
};

}  // namespace boresight::tracking
