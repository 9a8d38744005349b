#include "services/simulator/world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "services/simulator/random.hpp"
#include "services/simulator/world/knots.hpp"

namespace boresight::simulator {

namespace {

// Margin of the precomputed road for traffic that starts or ends far from the ego vehicle.
constexpr double kMargin_m = 1500.0;
// Largest ratio of the distance along the road to the straight distance; a right-angled turn gives √2.
constexpr double kMaxDetour = 1.5;
// Largest distance from a mirror's middle to its end, also for structures that lead off the road.
constexpr double kMaxHalfMirror_m = 60.0;
constexpr double kSideLoss_db = 4.0;  // mirror loss of a vehicle's side, which is less plane than a wall

Gap widened(Gap extent, double by_m) {
  return {extent.from_m - by_m, extent.to_m + by_m};
}

double distance_m(const Eigen::Vector2d& p, const MirrorSurface& s) {
  const Eigen::Vector2d along = s.to_m - s.from_m;
  const double share = std::clamp((p - s.from_m).dot(along) / std::max(1e-9, along.squaredNorm()), 0.0, 1.0);
  return (s.from_m + share * along - p).norm();
}

template <typename Placed>
void sort_by_arc(std::vector<Placed>& placed) {
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.arc_m < b.arc_m; });
}

/// Visits the entries of a sorted list with from ≤ arc < to.
template <typename Placed, typename Visit>
void for_arcs(const std::vector<Placed>& placed, Gap arcs, const Visit& visit) {
  const auto before = [](const Placed& p, double arc) { return p.arc_m < arc; };
  const auto last = std::lower_bound(placed.begin(), placed.end(), arcs.to_m, before);
  for (auto p = std::lower_bound(placed.begin(), last, arcs.from_m, before); p != last; ++p) visit(*p);
}

/// Refuses a scenario with too many points, so that a typing error in a spacing does not exhaust the memory.
void expect_moderate(const Scenario& scenario, Gap extent) {
  double sum = 0.0;
  const auto add = [&](const char* what, std::size_t index, double parts) {
    sum += parts;
    if (sum <= World::kMaxParts) return;
    throw std::invalid_argument("scenario " + scenario.name + ": " + what + "[" + std::to_string(index) +
                                "] has about " + std::to_string(static_cast<long long>(parts)) +
                                " points along the ego vehicle's path; all structures and scatter together may have " +
                                std::to_string(static_cast<long long>(World::kMaxParts)) +
                                ": choose a wider spacing or a shorter duration");
  };
  for (std::size_t i = 0; i < scenario.structures.size(); ++i) {
    add("structure", i, most_parts(scenario.structures[i], extent));
  }
  for (std::size_t i = 0; i < scenario.scatter.size(); ++i) add("scatter", i, most_parts(scenario.scatter[i], extent));
}

}  // namespace

World::World(const Scenario& scenario, std::uint64_t seed, double duration_s)
    : ego_(scenario.ego),
      road_(scenario.road, std::min(0.0, ego_extent(scenario.ego, duration_s).from_m) - kMargin_m,
            std::max(0.0, ego_extent(scenario.ego, duration_s).to_m) + kMargin_m) {
  const Gap extent = widened(ego_extent(scenario.ego, duration_s), kMaxDetour * kReach_m);
  expect_moderate(scenario, extent);
  for (std::size_t i = 0; i < scenario.structures.size(); ++i) {
    add_structure(scenario.structures[i], i, road_, extent, seed, roadside_);
  }
  for (std::size_t i = 0; i < scenario.scatter.size(); ++i) {
    add_scatter(scenario.scatter[i], i, road_, extent, seed, roadside_);
  }
  sort_by_arc(roadside_.surfaces);
  sort_by_arc(roadside_.scatterers);
  for (const BodySpec& spec : scenario.bodies) add_actor(spec, static_cast<std::uint32_t>(actors_.size() + 1), seed);
  for (std::size_t i = 0; i < scenario.scatter.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(i + 1) * kParkedIds;
    for (const ParkedCar& car : parked_cars(scenario.scatter[i], i, extent, seed)) {
      add_actor(car.spec, first + car.place, seed);
    }
  }
}

void World::add_actor(const BodySpec& spec, std::uint32_t id, std::uint64_t seed) {
  Actor actor{spec, Stream(seed, "gait", id - 1).uniform(), {}};
  if (actor.spec.parked) {
    actor.spec.speed_mps.clear();
    actor.spec.swing_mps = 0.0;
  }
  const Dimensions usual = dimensions_of(spec.kind);
  Body& body = actor.body;
  body.id = id;
  body.kind = spec.kind;
  body.parked = spec.parked;
  body.length_m = spec.length_m > 0.0 ? spec.length_m : usual.length_m;
  body.width_m = spec.width_m > 0.0 ? spec.width_m : usual.width_m;
  body.height_m = spec.height_m > 0.0 ? spec.height_m : usual.height_m;
  body.clearance_m = usual.clearance_m;
  body.side_low_m = spec.side_low_m > 0.0 ? spec.side_low_m : usual.side_low_m;
  body = placed(actor, body_motion(actor.spec, road_, 0.0));
  actors_.push_back(std::move(actor));
}

Body World::placed(const Actor& actor, const Motion& motion) const {
  Body body = actor.body;
  body.position_m = motion.position_m;
  body.heading_rad = motion.heading_rad;
  body.velocity_mps = motion.velocity_mps();
  body.yaw_rate_radps = motion.yaw_rate_radps;
  return body;
}

EgoState World::ego(double t_s) const {
  const Motion m = ego_motion(ego_, road_, t_s);
  return {{m.position_m, m.heading_rad, m.speed_mps, m.acceleration_mps2, m.yaw_rate_radps}, m.arc_m};
}

Motion World::motion(std::size_t index, double t_s) const {
  return body_motion(actors_[index].spec, road_, t_s);
}

Body World::body(std::size_t index, double t_s) const {
  return placed(actors_[index], motion(index, t_s));
}

void World::at(double t_s, double reach_m, Scene& scene) const {
  const EgoState ego = this->ego(t_s);
  scene.t_s = t_s;
  scene.ego = ego;
  scene.bodies.clear();
  scene.centres.clear();
  scene.surfaces.clear();
  scene.scatterers.clear();
  for (const Actor& actor : actors_) {
    // The place of a parked body is constant; only that of the others is computed.
    if (actor.spec.parked) {
      const double gap_m = (actor.body.position_m - ego.position_m).norm() - 0.5 * actor.body.length_m;
      if (gap_m > reach_m) continue;
    }
    const Motion motion = actor.spec.parked ? Motion{} : body_motion(actor.spec, road_, t_s);
    Body body = actor.spec.parked ? actor.body : placed(actor, motion);
    if ((body.position_m - ego.position_m).norm() - 0.5 * body.length_m > reach_m) continue;
    add_centres(body, motion.travelled_m, motion.speed_mps, actor.phase, scene.centres);
    add_sides(body, kSideLoss_db, scene.surfaces);
    scene.bodies.push_back(body);
  }
  const Gap arcs = widened({ego.arc_m, ego.arc_m}, kMaxDetour * reach_m + kMaxHalfMirror_m);
  for_arcs(roadside_.surfaces, arcs, [&](const PlacedSurface& p) {
    if (distance_m(ego.position_m, p.surface) <= reach_m) scene.surfaces.push_back(p.surface);
  });
  for_arcs(roadside_.scatterers, arcs, [&](const PlacedScatterer& p) {
    if ((p.scatterer.position_m.head<2>() - ego.position_m).norm() <= reach_m) {
      scene.scatterers.push_back(p.scatterer);
    }
  });
}

}  // namespace boresight::simulator
