// The road as a curve, and the ego vehicle's drive along it.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tests/simulator/scenario.hpp"

namespace boresight::simulator {

/// A point of the road: position and heading of its centre line at an arc length.
struct RoadPoint {
  Eigen::Vector2d position_m;
  double heading_rad;
  double curvature_per_m;
};

/// Centre line of the ego lane by arc length, precomputed from `begin_m` to `end_m`.
class Road {
 public:
  Road(double begin_m, double end_m, double curvature);
  [[nodiscard]] RoadPoint at(double arc_m) const;
  /// World position left of the centre line by `lateral_m`.
  [[nodiscard]] Eigen::Vector2d place(double arc_m, double lateral_m) const;

 private:
  double begin_m_;
  std::vector<RoadPoint> points_;
};

/// The ego vehicle's rear axle: it follows the centre line without slip.
struct EgoState {
  double arc_m;
  Eigen::Vector2d position_m;
  double heading_rad;
  double speed_mps;
  double yaw_rate_radps;
};

/// Arc length and speed at time t for a speed that swings about its mean.
[[nodiscard]] double ego_arc_m(const Scenario& scenario, double t_s);
[[nodiscard]] double ego_speed_mps(const Scenario& scenario, double t_s);
[[nodiscard]] EgoState ego_state(const Scenario& scenario, const Road& road, double t_s);

}  // namespace boresight::simulator
