// Motion along the road.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "services/simulator/road.hpp"
#include "services/simulator/scenario.hpp"

namespace boresight::simulator {

/// Motion of a rigid body in the plane, without slip: the velocity points along the heading or against it.
struct Motion {
  double arc_m;      ///< road position; for crossing bodies, that of the start
  double lateral_m;  ///< from the road's line, positive to the left
  double arc_speed_mps;
  double travelled_m;  ///< since the drive began, along the heading
  Eigen::Vector2d position_m;
  double heading_rad;
  double speed_mps;  ///< along the heading
  double acceleration_mps2;
  double yaw_rate_radps;

  [[nodiscard]] Eigen::Vector2d velocity_mps() const {
    return speed_mps * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  }
};

/// Motion along the road at a lateral offset that depends on the road position. `against`: heading against the road.
[[nodiscard]] Motion along_road(const Road& road, double arc_m, double arc_speed_mps, double arc_acceleration_mps2,
                                const Knots& lateral_m, bool against);

[[nodiscard]] Motion ego_motion(const EgoSpec& ego, const Road& road, double t_s);
[[nodiscard]] Motion body_motion(const BodySpec& body, const Road& road, double t_s);

/// Smallest and largest road position of the ego vehicle until `duration_s`.
[[nodiscard]] Gap ego_extent(const EgoSpec& ego, double duration_s);

}  // namespace boresight::simulator
