// The road as a curve.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "services/simulator/scenario.hpp"

namespace boresight::simulator {

/// A point of the road: position and heading of its line at an arc length.
struct RoadPoint {
  Eigen::Vector2d position_m;
  double heading_rad;
  double curvature_per_m;
  double curvature_slope_per_m2;  ///< along the arc
};

/// Line of the road by arc length, precomputed from `begin_m` ≤ 0 to `end_m`. Arc 0 is the world's origin, where the
/// road runs along the x axis. Beyond either end the curvature stays constant.
class Road {
 public:
  Road(const RoadSpec& spec, double begin_m, double end_m);
  [[nodiscard]] RoadPoint at(double arc_m) const;
  /// World position left of the line by `lateral_m`.
  [[nodiscard]] Eigen::Vector2d place(double arc_m, double lateral_m) const;

 private:
  double begin_m_;
  std::vector<RoadPoint> points_;
};

/// Curvature at an arc length by the specification.
[[nodiscard]] double curvature_at(const RoadSpec& spec, double arc_m);

}  // namespace boresight::simulator
