// Position, velocity and orientation of the sensor in the world at an instant.
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

#include "services/common/geometry/frames.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/scene.hpp"

namespace boresight::simulator::radar {

struct Viewpoint {
  Eigen::Vector3d position_m;       ///< world
  Eigen::Vector3d velocity_mps;     ///< over ground, world axes
  Eigen::Matrix3d sensor_to_world;  ///< with the true mounting
};

/// `mounting`: its position, and `sensor_to_vehicle`: the true mounting, not the configured one.
[[nodiscard]] inline Viewpoint viewpoint(const EgoPose& ego, const MountingPose& mounting,
                                         const Eigen::Matrix3d& sensor_to_vehicle) {
  const double c = std::cos(ego.heading_rad), s = std::sin(ego.heading_rad);
  Eigen::Matrix3d vehicle_to_world;
  vehicle_to_world << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  // The body pitches about the rear axle. The vehicle moves along the road all the same.
  Eigen::Matrix3d body_to_world = vehicle_to_world;
  if (ego.body_pitch_rad != 0.0) body_to_world *= geometry::sensor_to_vehicle(0.0, ego.body_pitch_rad, 0.0);
  const Eigen::Vector3d mount(mounting.position_m.data());
  return {Eigen::Vector3d(ego.position_m.x(), ego.position_m.y(), 0.0) + body_to_world * mount,
          vehicle_to_world * geometry::sensor_velocity(1.0, ego.speed_mps, ego.yaw_rate_radps, mounting.position_m,
                                                       ego.lateral_speed_mps),
          body_to_world * sensor_to_vehicle};
}

}  // namespace boresight::simulator::radar
