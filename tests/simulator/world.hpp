// What reflects: the stationary roadside and the vehicles.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tests/simulator/road.hpp"
#include "tests/simulator/scenario.hpp"

namespace boresight::simulator {

struct StationaryPoint {
  double arc_m;  ///< for finding neighbours; points are sorted by it
  Eigen::Vector3d position_m;
  double rcs_dbsm;
};

/// A vehicle at an instant, world frame.
struct VehicleState {
  std::uint32_t id;
  double arc_m;
  Eigen::Vector2d position_m;  ///< centre
  double heading_rad;
  Eigen::Vector2d velocity_mps;
  double yaw_rate_radps;
  double length_m;
  double width_m;
};

class World {
 public:
  World(const Scenario& scenario, std::uint64_t seed, double duration_s);

  [[nodiscard]] const Road& road() const { return road_; }
  /// Stationary points with begin ≤ arc < end.
  [[nodiscard]] std::pair<const StationaryPoint*, const StationaryPoint*> points(double begin_m, double end_m) const;
  [[nodiscard]] VehicleState vehicle(std::size_t index, double t_s) const;
  [[nodiscard]] std::size_t number_of_vehicles() const { return scenario_.vehicles.size(); }

 private:
  void add_roadside(std::uint64_t seed, double begin_m, double end_m);
  Scenario scenario_;
  Road road_;
  std::vector<StationaryPoint> points_;
};

/// A vehicle-like pose on the road at a lateral offset, moving along it at `arc_speed_mps`.
[[nodiscard]] VehicleState on_road(const Road& road, double arc_m, double lateral_m, double arc_speed_mps);

}  // namespace boresight::simulator
