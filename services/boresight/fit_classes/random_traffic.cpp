#include "services/boresight/fit_classes/random_traffic.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "services/simulator/random.hpp"

namespace boresight::fit_classes {

using namespace simulator;

namespace {

struct Span {
  double least, most;
  [[nodiscard]] double draw(Stream& random) const { return random.uniform(least, most); }
};

/// What a road user of a kind may be: sizes in metres, speeds in m/s.
struct Kind {
  BodyKind kind;
  Span length_m, width_m, height_m;
  Span speed_mps, slow_mps;
  Span lateral_m;  // beside the road's line
};

constexpr std::array<Kind, 5> kKinds = {{
    {BodyKind::kPedestrian, {0.4, 0.8}, {0.4, 0.8}, {1.5, 1.95}, {0.8, 2.2}, {0.5, 4.0}, {3.5, 9.0}},
    {BodyKind::kCyclist, {1.6, 2.1}, {0.5, 0.8}, {1.6, 1.9}, {3.0, 8.0}, {1.5, 12.0}, {2.5, 7.0}},
    {BodyKind::kCar, {3.7, 5.1}, {1.65, 2.0}, {1.4, 1.8}, {5.0, 33.0}, {0.8, 5.0}, {0.0, 8.0}},
    {BodyKind::kVan, {5.0, 6.5}, {1.9, 2.15}, {2.0, 2.8}, {5.0, 30.0}, {0.8, 5.0}, {0.0, 8.0}},
    {BodyKind::kTruck, {7.0, 17.0}, {2.4, 2.55}, {3.0, 4.0}, {5.0, 25.0}, {0.8, 5.0}, {0.0, 8.0}},
}};

constexpr double kSlowShare = 0.25;
constexpr double kCrossingShare = 0.35;
constexpr double kSecondsPerBody = 1.1;  // one more road user for each of these
constexpr double kLane_m = 3.5;

void add_roadside(Scenario& scenario, Stream& random, double from_m, double to_m) {
  const auto side = [&] { return random.uniform() < 0.5 ? -1.0 : 1.0; };
  if (random.uniform() < 0.6) {
    StructureSpec rail;
    rail.kind = random.uniform() < 0.5 ? StructureKind::kGuardRail : StructureKind::kFacade;
    rail.from_m = from_m;
    rail.to_m = to_m;
    rail.lateral_m = side() * random.uniform(10.0, 18.0);
    rail.gap_every_m = random.uniform(30.0, 90.0);
    rail.gap_length_m = random.uniform(2.0, 12.0);
    if (rail.kind == StructureKind::kFacade) rail.low_m = 0.0, rail.high_m = 9.0;
    scenario.structures.push_back(rail);
  }
  for (const ScatterKind kind : {ScatterKind::kColumns, ScatterKind::kVegetation, ScatterKind::kKerb}) {
    if (random.uniform() < 0.4) continue;
    ScatterSpec scatter;
    scatter.kind = kind;
    scatter.from_m = from_m;
    scatter.to_m = to_m;
    scatter.lateral_min_m = random.uniform(9.0, 13.0);
    scatter.lateral_max_m = scatter.lateral_min_m + random.uniform(0.2, 6.0);
    scatter.per_m = random.uniform(0.05, kind == ScatterKind::kColumns ? 0.3 : 1.2);
    scenario.scatter.push_back(scatter);
  }
}

BodySpec body_of(const Kind& kind, Stream& random, double ego_mps, double duration_s) {
  BodySpec body;
  body.kind = kind.kind;
  body.length_m = kind.length_m.draw(random);
  body.width_m = kind.width_m.draw(random);
  body.height_m = kind.height_m.draw(random);
  const double speed_mps = random.uniform() < kSlowShare ? kind.slow_mps.draw(random) : kind.speed_mps.draw(random);
  body.swing_mps = random.uniform() < 0.5 ? 0.0 : random.uniform(0.0, 0.25) * speed_mps;
  body.swing_period_s = random.uniform(8.0, 30.0);
  // Where it is when it is near, and how it moves there.
  const double near_s = random.uniform(0.0, duration_s);
  const double near_m = ego_mps * near_s + random.uniform(-30.0, 65.0);
  if (random.uniform() < kCrossingShare) {
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    const double angle_rad = random.uniform(30.0, 150.0) * std::numbers::pi / 180.0;
    // It crosses the line at `near_m` plus its travel before that time.
    const double lateral_m = side * (speed_mps * near_s * std::sin(angle_rad) + random.uniform(2.5, 20.0));
    body.heading_rad = -side * angle_rad;
    body.start_m = near_m - speed_mps * near_s * std::cos(angle_rad);
    body.lateral_m = {{0.0, lateral_m}};
    body.speed_mps = {{0.0, speed_mps}};
    return body;
  }
  const bool is_oncoming = random.uniform() < 0.4;
  const double arc_mps = is_oncoming ? -speed_mps : speed_mps;
  const double side = is_oncoming ? 1.0 : random.uniform() < 0.7 ? -1.0 : 1.0;
  double lateral_m = side * std::max(kLane_m, kind.lateral_m.draw(random));
  const bool is_vehicle = kind.kind == BodyKind::kCar || kind.kind == BodyKind::kVan || kind.kind == BodyKind::kTruck;
  if (is_vehicle) lateral_m = side * kLane_m * (random.uniform() < 0.6 ? 1.0 : 2.0) + random.uniform(-0.4, 0.4);
  body.start_m = near_m - arc_mps * near_s;
  body.lateral_m = {{0.0, lateral_m}};
  body.speed_mps = {{0.0, arc_mps}};
  return body;
}

}  // namespace

Scenario random_traffic(std::uint64_t seed, double duration_s) {
  Stream random(seed, "random_traffic");
  Scenario scenario;
  scenario.name = "random_traffic";
  scenario.about = "road users of all classes at random places";
  scenario.duration_s = duration_s;
  constexpr std::array<Span, 4> kEgoSpeeds_mps = {{{0.0, 3.0}, {5.0, 14.0}, {12.0, 22.0}, {20.0, 33.0}}};
  const double ego_mps = kEgoSpeeds_mps[random.next() % kEgoSpeeds_mps.size()].draw(random);
  scenario.ego.speed_mps = {{0.0, ego_mps}};
  scenario.ego.swing_mps = random.uniform(0.0, 0.2) * ego_mps;
  if (random.uniform() < 0.5) {
    const double radius_m = random.uniform(120.0, 900.0);
    const double curvature_per_m = (random.uniform() < 0.5 ? -1.0 : 1.0) / radius_m;
    scenario.road.segments = {{random.uniform(40.0, 200.0), 0.0}, {random.uniform(60.0, 250.0), curvature_per_m}};
    scenario.road.segments.push_back({1000.0, 0.0});
  }
  add_roadside(scenario, random, -100.0, ego_mps * duration_s + 150.0);
  const auto bodies = static_cast<std::size_t>(duration_s / kSecondsPerBody);
  for (std::size_t i = 0; i < bodies; ++i) {
    scenario.bodies.push_back(body_of(kKinds[i % kKinds.size()], random, ego_mps, duration_s));
  }
  return scenario;
}

}  // namespace boresight::fit_classes
