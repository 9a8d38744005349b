// The simulated structures beside the road as lines in the vehicle frame.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "services/simulator/world.hpp"

namespace boresight::bench::surroundings {

/// One structure along the road: rail, wall, barrier, wall of a tunnel, facade, kerb, or row of parked cars.
struct TrueEdge {
  bool is_left = true;
  bool is_loose = false;  ///< a row of poles or parked cars: an edge, but without an exact place
  bool hides = false;     ///< a row of parked cars hides the structures behind it
  std::vector<Eigen::Vector2d> places_vehicle_m;  ///< along the road; gaps split a structure

  /// Its y at an x of the vehicle frame, if it is there.
  [[nodiscard]] std::optional<double> at(double x_m) const;
};

/// The structures from 10 m behind the vehicle to 60 m ahead. Those that lead off the road are not included. A row of
/// parked cars is the line of their sides towards the road.
[[nodiscard]] std::vector<TrueEdge> true_edges(const simulator::Scenario& scenario, const simulator::World& world,
                                               const simulator::EgoState& ego);

}  // namespace boresight::bench::surroundings
