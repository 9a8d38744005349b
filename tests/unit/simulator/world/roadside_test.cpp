// Reflection centres move with their bodies; structures stand at the requested places.
#include <algorithm>

#include <gtest/gtest.h>

#include "services/simulator/world/reflections.hpp"
#include "services/simulator/world/structures.hpp"

namespace boresight::simulator {
namespace {

class Kinds : public testing::TestWithParam<BodyKind> {};

TEST_P(Kinds, CentresHaveTheVelocityOfTheirPlaces) {
  const Road road({{{50.0, 0.0}, {200.0, 0.03}}, 30.0, {}}, -100.0, 500.0);
  BodySpec spec;
  spec.kind = GetParam();
  spec.speed_mps = {{0.0, 3.0}, {4.0, 9.0}};
  const auto centres_at = [&](double t) {
    const Motion m = body_motion(spec, road, t);
    const Dimensions size = dimensions_of(spec.kind);
    Body body{};
    body.kind = spec.kind;
    body.position_m = m.position_m;
    body.heading_rad = m.heading_rad;
    body.velocity_mps = m.velocity_mps();
    body.yaw_rate_radps = m.yaw_rate_radps;
    body.length_m = size.length_m;
    body.width_m = size.width_m;
    std::vector<ReflectionCentre> centres;
    add_centres(body, m.travelled_m, m.speed_mps, 0.37, centres);
    EXPECT_EQ(body.number_of_centres, centres.size());
    return centres;
  };
  bool any_micro = false;
  for (double t = 0.1; t < 12.0; t += 0.171) {
    const auto now = centres_at(t), before = centres_at(t - 1e-4), after = centres_at(t + 1e-4);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Eigen::Vector3d velocity = (after[i].position_m - before[i].position_m) / 2e-4;
      // The effect of the body's rotation on the swing of a limb is neglected.
      ASSERT_NEAR((now[i].velocity_mps - velocity).norm(), 0.0, 0.1) << "centre " << i << " at " << t;
      ASSERT_GE(now[i].position_m.z(), 0.0);
      any_micro = any_micro || std::abs(now[i].velocity_mps.norm() - now[0].velocity_mps.norm()) > 1.0;
      ASSERT_TRUE(now[i].facing.norm() == 0.0 || std::abs(now[i].facing.norm() - 1.0) < 1e-9);
    }
  }
  EXPECT_TRUE(any_micro) << "rims and limbs move";
}

INSTANTIATE_TEST_SUITE_P(All, Kinds,
                         testing::Values(BodyKind::kCar, BodyKind::kVan, BodyKind::kTruck, BodyKind::kPedestrian,
                                         BodyKind::kCyclist));

TEST(Sides, OnlyLargeVehiclesMirrorWithAllFour) {
  Body body{};
  body.id = 7;
  body.kind = BodyKind::kTruck;
  body.position_m = {10.0, 5.0};
  body.heading_rad = 0.4;
  body.length_m = 12.0;
  body.width_m = 2.5;
  body.height_m = 3.8;
  body.clearance_m = 0.8;
  body.side_low_m = 0.5;
  body.velocity_mps = {3.0, 1.0};
  std::vector<MirrorSurface> sides;
  add_sides(body, 4.0, sides);
  ASSERT_EQ(sides.size(), 4u);
  double around_m = 0.0;
  for (const MirrorSurface& s : sides) {
    around_m += (s.to_m - s.from_m).norm();
    EXPECT_EQ(s.body_id, 7u);
    EXPECT_EQ(s.velocity_mps, body.velocity_mps);
    EXPECT_EQ(s.low_m, 0.5) << "height of its guards, not its clearance";
    EXPECT_EQ(s.high_m, 3.8);
  }
  EXPECT_NEAR(around_m, 29.0, 1e-9);
  body.kind = BodyKind::kPedestrian;
  add_sides(body, 4.0, sides);
  EXPECT_EQ(sides.size(), 4u);
}

StructureSpec rail() {
  StructureSpec s;
  s.from_m = -50.0;
  s.to_m = 400.0;
  s.lateral_m = -4.0;
  s.roughness_m = 0.0;
  return s;
}

constexpr Gap kAll{-1000.0, 1000.0};

Roadside roadside_of(const StructureSpec& spec, const Road& road = Road({}, -300.0, 700.0)) {
  Roadside roadside;
  add_structure(spec, 0, road, kAll, 1, roadside);
  return roadside;
}

TEST(Structures, ARailFollowsItsLineWithinCentimetresAndOpensAtItsGaps) {
  const Road road({{{100.0, 0.0}, {150.0, 0.01}, {200.0, -0.005}}, 30.0, {}}, -300.0, 700.0);
  StructureSpec spec = rail();
  spec.gaps = {{120.0, 126.0}, {380.0, 500.0}};
  spec.gap_every_m = 100.0;
  spec.gap_length_m = 3.0;
  const Roadside roadside = roadside_of(spec, road);
  const auto distance_m = [&](const Eigen::Vector2d& p) {
    double nearest = 1e9;
    for (const PlacedSurface& s : roadside.surfaces) {
      const Eigen::Vector2d along = s.surface.to_m - s.surface.from_m;
      const double share = std::clamp((p - s.surface.from_m).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (s.surface.from_m + share * along - p).norm());
    }
    return nearest;
  };
  const auto open = [](double arc) {
    // Regular gaps are 100 m apart from the rail's beginning.
    return (arc > 120.0 && arc < 126.0) || arc > 380.0 || (arc > 50.0 && arc < 53.0) || (arc > 150.0 && arc < 153.0) ||
           (arc > 250.0 && arc < 253.0) || (arc > 350.0 && arc < 353.0);
  };
  for (double arc = -49.9; arc < 399.0; arc += 0.37) {
    if (!open(arc)) {
      ASSERT_LT(distance_m(road.place(arc, -4.0)), 0.035) << arc;
    } else if (!open(arc - 1.0) || !open(arc + 1.0)) {
      continue;
    } else {
      ASSERT_GT(distance_m(road.place(arc, -4.0)), 0.9) << arc;
    }
  }
  for (const PlacedScatterer& p : roadside.scatterers) {
    EXPECT_FALSE(open(p.arc_m)) << p.arc_m;
    EXPECT_LT(distance_m(p.scatterer.position_m.head<2>()), 0.035);
  }
  EXPECT_NEAR(static_cast<double>(roadside.scatterers.size()), (430.0 - 6.0 - 12.0) / 2.0, 8.0);
  EXPECT_LT(roadside.surfaces.size(), 80u) << "no more mirrors than the curve needs";
}

TEST(Structures, AWallOffTheRoadIsStraight) {
  const Road road({{{100.0, 0.0}, {150.0, 0.01}}, 30.0, {}}, -300.0, 700.0);
  StructureSpec spec = rail();
  spec.kind = StructureKind::kWall;
  spec.from_m = 20.0;
  spec.to_m = 60.0;
  spec.heading_rad = -0.5 * M_PI;
  const Roadside roadside = roadside_of(spec, road);
  ASSERT_EQ(roadside.surfaces.size(), 2u);
  EXPECT_NEAR(roadside.surfaces.back().surface.to_m.y(), -44.0, 1e-9);
  EXPECT_NEAR(roadside.surfaces.back().surface.to_m.x(), 20.0, 1e-9);
}

TEST(Structures, ATunnelHasTwoWallsAndACeiling) {
  StructureSpec spec = rail();
  spec.kind = StructureKind::kTunnel;
  spec.low_m = 0.0;
  spec.high_m = 5.0;
  spec.width_m = 9.0;
  spec.lateral_m = 4.0;
  const Roadside roadside = roadside_of(spec);
  for (const PlacedSurface& s : roadside.surfaces) {
    EXPECT_TRUE(std::abs(s.surface.from_m.y() - 4.0) < 1e-9 || std::abs(s.surface.from_m.y() + 5.0) < 1e-9);
  }
  const auto ceiling = std::count_if(roadside.scatterers.begin(), roadside.scatterers.end(),
                                     [](const PlacedScatterer& p) { return p.scatterer.position_m.z() == 5.0; });
  EXPECT_NEAR(static_cast<double>(ceiling), 225.0, 2.0);
  for (const PlacedScatterer& p : roadside.scatterers) {
    EXPECT_LE(p.scatterer.position_m.y(), 4.0 + 1e-9);
    EXPECT_GE(p.scatterer.position_m.y(), -5.0 - 1e-9);
  }
}

TEST(Structures, PillarsAreSquare) {
  StructureSpec spec = rail();
  spec.kind = StructureKind::kPillars;
  spec.from_m = 0.0;
  spec.to_m = 29.0;
  spec.spacing_m = 10.0;
  spec.width_m = 0.6;
  const Roadside roadside = roadside_of(spec);
  EXPECT_EQ(roadside.surfaces.size(), 12u);
  for (const PlacedSurface& s : roadside.surfaces) {
    EXPECT_NEAR((s.surface.to_m - s.surface.from_m).norm(), 0.6, 1e-9);
  }
}

TEST(Scatter, StandsWithinItsBordersAsDenselyAsAsked) {
  const Road road({}, -300.0, 2300.0);
  ScatterSpec spec;
  spec.kind = ScatterKind::kVegetation;
  spec.from_m = 0.0;
  spec.to_m = 2000.0;
  spec.lateral_min_m = 8.0;
  spec.lateral_max_m = 12.0;
  spec.per_m = 0.5;
  Roadside roadside;
  add_scatter(spec, 0, road, {-1e4, 1e4}, 3, roadside);
  EXPECT_NEAR(static_cast<double>(roadside.scatterers.size()), 1000.0, 4.0 * std::sqrt(1000.0));
  std::size_t left = 0;
  for (const PlacedScatterer& p : roadside.scatterers) {
    const double aside = std::abs(p.scatterer.position_m.y());
    EXPECT_TRUE(aside >= 8.0 && aside <= 12.0) << aside;
    left += p.scatterer.position_m.y() > 0.0 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(left), 500.0, 100.0);
}

TEST(Scatter, ParkedCarsDoNotTouch) {
  ScatterSpec spec;
  spec.kind = ScatterKind::kParkedCars;
  spec.from_m = 0.0;
  spec.to_m = 1000.0;
  spec.lateral_min_m = spec.lateral_max_m = 5.0;
  spec.per_m = 0.15;
  for (const double heading : {0.0, 0.5 * M_PI}) {
    spec.heading_rad = heading;
    for (const bool both : {false, true}) {
      spec.both_sides = both;
      const auto cars = parked_cars(spec, 0, kAll, 4);
      EXPECT_NEAR(static_cast<double>(cars.size()), both ? 300.0 : 150.0, 60.0);
      for (std::size_t i = 0; i < cars.size(); ++i) {
        EXPECT_TRUE(cars[i].spec.parked);
        for (std::size_t k = 0; k < i; ++k) {
          if (cars[i].spec.lateral_m[0].value * cars[k].spec.lateral_m[0].value < 0.0) continue;
          EXPECT_GT(std::abs(cars[i].spec.start_m - cars[k].spec.start_m), heading == 0.0 ? 5.0 : 2.0);
        }
      }
    }
  }
}

}  // namespace
}  // namespace boresight::simulator
