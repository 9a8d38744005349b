// The world of a scenario: where everything is at an instant.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tests/simulator/road.hpp"
#include "tests/simulator/scenario.hpp"
#include "tests/simulator/scene.hpp"
#include "tests/simulator/world/motion.hpp"
#include "tests/simulator/world/reflections.hpp"
#include "tests/simulator/world/structures.hpp"

namespace boresight::simulator {

/// The ego vehicle's rear axle, and where on the road that is.
struct EgoState : EgoPose {
  double arc_m;
};

class World {
 public:
  /// Builds what stands within kSight_m of the ego vehicle until `duration_s`. What stands where depends on the seed
  /// only, not on the duration. Throws std::invalid_argument for more than kMostParts points, mirrors and parked cars.
  static constexpr double kSight_m = 300.0;
  static constexpr double kMostParts = 5e6;
  World(const Scenario& scenario, std::uint64_t seed, double duration_s);

  /// What is within `reach_m` (≤ kSight_m) of the ego vehicle's origin at `t_s`: bodies and mirrors by their nearest
  /// point. Buffers are kept: once they have grown to the busiest place there is no allocation.
  void at(double t_s, double reach_m, Scene& scene) const;

  [[nodiscard]] EgoState ego(double t_s) const;
  [[nodiscard]] const Road& road() const { return road_; }

  /// Of all bodies: those that the scenario tells one by one, whose Body::id is the index + 1, then parked cars that it
  /// scatters, whose ids are kParkedIds · (number of the scatter, from 1) + their place there: the same ids and draws
  /// whatever else is in the scenario and however long the drive is.
  static constexpr std::uint32_t kParkedIds = 1'000'000;
  [[nodiscard]] std::size_t number_of_bodies() const { return actors_.size(); }
  /// Without its centres.
  [[nodiscard]] Body body(std::size_t index, double t_s) const;
  [[nodiscard]] Motion motion(std::size_t index, double t_s) const;

 private:
  struct Actor {
    BodySpec spec;
    GaitPhase phase;
    Body body;  ///< of what is parked: at its place
  };
  void add_actor(const BodySpec& spec, std::uint32_t id, std::uint64_t seed);
  [[nodiscard]] Body placed(const Actor& actor, const Motion& motion) const;
  EgoSpec ego_;
  Road road_;
  Roadside roadside_;
  std::vector<Actor> actors_;
};

}  // namespace boresight::simulator
