// How things move along the road.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "tests/simulator/road.hpp"
#include "tests/simulator/scenario.hpp"

namespace boresight::simulator {

/// A rigid body's motion in the plane, without slip: the velocity points where it heads, or away from there.
struct Motion {
  double arc_m;      ///< road position; of what crosses, where it began
  double lateral_m;  ///< off the road's line
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

/// Along the road at an offset that depends on the place. `against`: heads against the road's direction.
[[nodiscard]] Motion along_road(const Road& road, double arc_m, double arc_speed_mps, double arc_acceleration_mps2,
                                const Knots& lateral_m, bool against);

[[nodiscard]] Motion ego_motion(const EgoSpec& ego, const Road& road, double t_s);
[[nodiscard]] Motion body_motion(const BodySpec& body, const Road& road, double t_s);

/// Road positions between which the ego vehicle stays until `duration_s`.
[[nodiscard]] Gap ego_extent(const EgoSpec& ego, double duration_s);

}  // namespace boresight::simulator
