// A true object, in the form of an entry of the ego vehicle's track list.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace boresight::judge {

/// Position in the vehicle frame; velocity over ground, in the vehicle's axes.
struct Object {
  std::uint32_t id;
  Eigen::Vector2d position_m;  ///< centre
  Eigen::Vector2d velocity_mps;
  double heading_rad;
  double length_m, width_m;
  bool is_hidden = false;  ///< hidden from all radars (hidden.hpp)

  /// Distance of a point from the object's box, 0 inside.
  [[nodiscard]] double distance_m(const Eigen::Vector2d& point) const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    const Eigen::Vector2d d = point - position_m;
    const Eigen::Vector2d beyond(std::abs(c * d.x() + s * d.y()) - 0.5 * length_m,
                                 std::abs(-s * d.x() + c * d.y()) - 0.5 * width_m);
    return beyond.cwiseMax(0.0).norm();
  }
};

}  // namespace boresight::judge
