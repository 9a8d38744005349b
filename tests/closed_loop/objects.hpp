// The simulated bodies that are not parked, as the ego vehicle would have them on its list.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "tests/simulator/drive.hpp"

namespace boresight::closed_loop {

/// In the vehicle's frame and axes; velocity over ground.
struct Object {
  std::uint32_t id;
  Eigen::Vector2d position_m;  ///< centre
  Eigen::Vector2d velocity_mps;
  double heading_rad;
  double length_m, width_m;

  /// Distance of a point from the object's box, 0 inside.
  [[nodiscard]] double distance_m(const Eigen::Vector2d& point) const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    const Eigen::Vector2d d = point - position_m;
    const Eigen::Vector2d beyond(std::abs(c * d.x() + s * d.y()) - 0.5 * length_m,
                                 std::abs(-s * d.x() + c * d.y()) - 0.5 * width_m);
    return beyond.cwiseMax(0.0).norm();
  }
};

[[nodiscard]] inline std::vector<Object> objects_at(const simulator::Drive& drive, double t_s) {
  const simulator::EgoState ego = drive.ego(t_s);
  Eigen::Matrix2d to_vehicle;
  to_vehicle << std::cos(ego.heading_rad), std::sin(ego.heading_rad), -std::sin(ego.heading_rad),
      std::cos(ego.heading_rad);
  std::vector<Object> objects;
  for (std::size_t i = 0; i < drive.world().number_of_bodies(); ++i) {
    const simulator::Body b = drive.world().body(i, t_s);
    if (b.parked) continue;
    objects.push_back({b.id, to_vehicle * (b.position_m - ego.position_m), to_vehicle * b.velocity_mps,
                       b.heading_rad - ego.heading_rad, b.length_m, b.width_m});
  }
  return objects;
}

}  // namespace boresight::closed_loop
