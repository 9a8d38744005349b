#include "tests/simulator/world.hpp"

#include <algorithm>
#include <cmath>

#include "tests/simulator/random.hpp"

namespace boresight::simulator {

namespace {

constexpr double kMargin_m = 1500.0;  // room for traffic that starts or ends far from the ego vehicle

}  // namespace

World::World(const Scenario& scenario, std::uint64_t seed, double duration_s)
    : scenario_(scenario), road_(-kMargin_m, ego_arc_m(scenario, duration_s) + kMargin_m, scenario.curvature) {
  add_roadside(seed, -200.0, ego_arc_m(scenario, duration_s) + 200.0);
}

void World::add_roadside(std::uint64_t seed, double begin_m, double end_m) {
  const auto add = [&](double arc, double lateral, double height, double rcs) {
    const Eigen::Vector2d p = road_.place(arc, lateral);
    points_.push_back({arc, {p.x(), p.y(), height}, rcs});
  };
  constexpr double kSpacing_m = 2.0;
  std::uint64_t index = 0;
  for (double arc = begin_m; arc < end_m; arc += kSpacing_m, ++index) {
    Stream rail(seed, "rail", index);
    add(arc + rail.uniform(-0.3, 0.3), scenario_.rail_left_m + 0.05 * rail.gaussian(), rail.uniform(0.3, 0.8),
        rail.uniform(-8.0, 2.0));
    add(arc + rail.uniform(-0.3, 0.3), scenario_.rail_right_m + 0.05 * rail.gaussian(), rail.uniform(0.3, 0.8),
        rail.uniform(-8.0, 2.0));
    Stream roadside(seed, "roadside", index);
    // Poles, trees and walls: several points above each other, which give the spread in elevation.
    const unsigned columns = roadside.poisson(0.45 * scenario_.roadside_density);
    for (unsigned c = 0; c < columns; ++c) {
      const double side = roadside.uniform() < 0.5 ? -1.0 : 1.0;
      const double lateral = side * roadside.uniform(10.0, 40.0);
      const double top = roadside.uniform(1.0, 9.0);
      for (double height = 0.4; height < top; height += 1.7) {
        add(arc + roadside.uniform(-1.0, 1.0), lateral + 0.3 * roadside.gaussian(), height,
            roadside.uniform(-5.0, 10.0));
      }
    }
  }
  std::stable_sort(points_.begin(), points_.end(),
                   [](const StationaryPoint& a, const StationaryPoint& b) { return a.arc_m < b.arc_m; });
}

std::pair<const StationaryPoint*, const StationaryPoint*> World::points(double begin_m, double end_m) const {
  const auto before = [](const StationaryPoint& p, double arc) { return p.arc_m < arc; };
  const auto first = std::lower_bound(points_.begin(), points_.end(), begin_m, before);
  const auto last = std::lower_bound(first, points_.end(), end_m, before);
  return {points_.data() + (first - points_.begin()), points_.data() + (last - points_.begin())};
}

VehicleState on_road(const Road& road, double arc_m, double lateral_m, double arc_speed_mps) {
  const RoadPoint p = road.at(arc_m);
  const Eigen::Vector2d tangent(std::cos(p.heading_rad), std::sin(p.heading_rad));
  VehicleState state{};
  state.arc_m = arc_m;
  state.position_m = road.place(arc_m, lateral_m);
  // A parallel curve to the left of a left-hand bend is shorter.
  state.velocity_mps = arc_speed_mps * (1.0 - p.curvature_per_m * lateral_m) * tangent;
  state.heading_rad = arc_speed_mps < 0.0 ? p.heading_rad + M_PI : p.heading_rad;
  state.yaw_rate_radps = arc_speed_mps * p.curvature_per_m;
  return state;
}

VehicleState World::vehicle(std::size_t index, double t_s) const {
  const VehicleSpec& spec = scenario_.vehicles[index];
  VehicleState state = on_road(road_, spec.start_m + spec.speed_mps * t_s, spec.lateral_m, spec.speed_mps);
  state.id = static_cast<std::uint32_t>(index + 1);
  state.length_m = spec.length_m;
  state.width_m = spec.width_m;
  return state;
}

}  // namespace boresight::simulator
