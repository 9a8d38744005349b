// The world of a scenario: positions and velocities of everything at an instant.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/simulator/road.hpp"
#include "services/simulator/scenario.hpp"
#include "services/simulator/scene.hpp"
#include "services/simulator/world/motion.hpp"
#include "services/simulator/world/reflections.hpp"
#include "services/simulator/world/structures.hpp"

namespace boresight::simulator {

/// Pose of the ego vehicle's rear axle, and its position along the road.
struct EgoState : EgoPose {
  double arc_m;
};

class World {
 public:
  /// Builds the stationary world within kReach_m of the ego vehicle's path until `duration_s`. The places depend on the
  /// seed only, not on the duration. Throws std::invalid_argument for more than kMaxParts points, mirrors and parked
  /// cars.
  static constexpr double kReach_m = 300.0;
  static constexpr double kMaxParts = 5e6;
  World(const Scenario& scenario, std::uint64_t seed, double duration_s);

  /// Writes to `scene` everything within `reach_m` (≤ kReach_m) of the ego vehicle's origin at `t_s`, bodies and
  /// mirrors by their nearest point. Buffers are kept: once they have grown to the busiest place there is no
  /// allocation.
  void at(double t_s, double reach_m, Scene& scene) const;

  [[nodiscard]] EgoState ego(double t_s) const;
  [[nodiscard]] const Road& road() const { return road_; }

  /// Ids of bodies. A body that the scenario lists has its index + 1. A parked car of a [[scatter]] has
  /// kParkedIds · (number of the scatter, from 1) + its place there. Ids and random draws depend neither on the rest of
  /// the scenario nor on the duration.
  static constexpr std::uint32_t kParkedIds = 1'000'000;
  [[nodiscard]] std::size_t number_of_bodies() const { return actors_.size(); }
  /// The body without its reflection centres.
  [[nodiscard]] Body body(std::size_t index, double t_s) const;
  [[nodiscard]] Motion motion(std::size_t index, double t_s) const;

 private:
  struct Actor {
    BodySpec spec;
    GaitPhase phase;
    Body body;  ///< parked cars: at its place
  };
  void add_actor(const BodySpec& spec, std::uint32_t id, std::uint64_t seed);
  [[nodiscard]] Body placed(const Actor& actor, const Motion& motion) const;
  EgoSpec ego_;
  Road road_;
  Roadside roadside_;
  std::vector<Actor> actors_;
};

}  // namespace boresight::simulator
