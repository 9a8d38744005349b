#include <gtest/gtest.h>

#include "services/simulator/radar/ground.hpp"
#include "tests/unit/simulator/radar/bench_scene.hpp"

namespace boresight::simulator {
namespace {

/// A scatterer straight ahead, 40 m away.
struct Ahead : Bench {
  explicit Ahead(double height_m = kHeight_m) { scene.scatterers.push_back({{40.0, 0.0, height_m}, 5.0}); }
  Body& add_obstacle(double x, double y) {
    Body& body = add_body(3, {x, y, kHeight_m}, {0.0, 0.0, 0.0});
    body.parked = true;
    body.number_of_centres = 0;
    return body;
  }
};

TEST(Occlusion, ABodyHidesTargetsBehindItWithinItsHeights) {
  Ahead e;
  EXPECT_EQ(measure(e).count(), 1u);
  e.add_obstacle(20.0, 0.5);
  EXPECT_EQ(measure(e).count(), 0u);
  e.scene.bodies[0].position_m.y() = 0.95;  // the body's side is now 5 cm beside the line of sight
  EXPECT_EQ(measure(e).count(), 1u);
  e.scene.bodies[0].position_m.y() = 0.5;
  e.scene.bodies[0].clearance_m = 0.7;  // visible below the body
  EXPECT_EQ(measure(e).count(), 1u);
  Ahead high(3.0);  // the line of sight is 1.8 m high there
  high.add_obstacle(20.0, 0.5);
  EXPECT_EQ(measure(high).count(), 1u);
  high.scene.bodies[0].height_m = 2.0;
  EXPECT_EQ(measure(high).count(), 0u);
}

TEST(Occlusion, ATurnedBodyHidesWithItsOwnOutline) {
  Ahead e;
  e.add_obstacle(20.0, 1.5);  // half a width is 0.9, half a length 2
  EXPECT_EQ(measure(e).count(), 1u);
  e.scene.bodies[0].heading_rad = M_PI / 2.0;
  EXPECT_EQ(measure(e).count(), 0u);
}

TEST(Occlusion, AnOpaqueStructureHidesWithinItsHeightsOnly) {
  Ahead e;
  MirrorSurface& wall = e.add_rail({20.0, -3.0}, {20.0, 3.0});
  EXPECT_EQ(measure(e).count(), 0u);
  wall.opaque = false;
  EXPECT_EQ(measure(e).count(), 1u);
  wall.opaque = true;
  wall.high_m = 0.55;  // visible above the low rail
  EXPECT_EQ(measure(e).count(), 1u);
  wall.high_m = 0.9;
  wall.from_m.y() = 0.1;  // the wall's end is beside the line of sight
  EXPECT_EQ(measure(e).count(), 1u);
}

TEST(Occlusion, AWallDoesNotHideItsOwnFacets) {
  Ahead e;
  e.add_rail({39.8, -3.0}, {39.8, 3.0});
  EXPECT_EQ(measure(e).count(), 1u);
  e.scene.surfaces[0].from_m.x() = e.scene.surfaces[0].to_m.x() = 39.0;
  EXPECT_EQ(measure(e).count(), 0u);
}

TEST(Occlusion, AMovingBodyIsHiddenByAnotherButNotByItself) {
  Bench e;
  e.add_body(1, {30.0, 0.0, kHeight_m}, {10.0, 0.0, 0.0});
  EXPECT_EQ(measure(e).count(), 1u);
  e.add_body(2, {20.0, 0.0, kHeight_m}, {10.0, 0.0, 0.0});
  const Measured m = measure(e);
  ASSERT_EQ(m.count(), 1u);
  EXPECT_EQ(m.truth[0].object_id, 2u);
}

TEST(Occlusion, TheEgoVehiclesOwnBodyHidesTargets) {
  // A radar in the left front corner with a view to all sides does not see a target behind on the right.
  Bench e;
  e.ego_body = {-1.0, 3.7, 0.9, 0.15, 1.5};
  e.config.mounting_pose.position_m = {3.6, 0.8, kHeight_m};
  e.config.field_of_view = {-3.2, 3.2, -0.5, 0.5, 200.0};
  const auto seen = [&](double x, double y, double z = kHeight_m) {
    e.scene.scatterers = {{{x, y, z}, 5.0}};
    return measure(e).count() == 1;
  };
  EXPECT_TRUE(seen(20.0, 0.0));
  EXPECT_TRUE(seen(-20.0, 3.0));
  EXPECT_TRUE(seen(4.0, -20.0));
  EXPECT_FALSE(seen(-20.0, -3.0));
  EXPECT_FALSE(seen(1.0, -10.0));
  EXPECT_FALSE(seen(-20.0, 0.0));
  // The box rotates with the vehicle.
  e.scene.ego.heading_rad = M_PI;
  EXPECT_FALSE(seen(20.0, 3.0));
  EXPECT_TRUE(seen(-20.0, 0.0));
}

TEST(Occlusion, TheFieldOfViewEndsWhereConfigured) {
  Bench e;
  const auto seen = [&](double azimuth, double elevation, double range) {
    e.scene.scatterers = {
        {Eigen::Vector3d(0.0, 0.0, kHeight_m) + range * geometry::direction(azimuth, elevation), 5.0}};
    return measure(e).count() == 1;
  };
  EXPECT_TRUE(seen(1.29, 0.0, 50.0));
  EXPECT_FALSE(seen(1.31, 0.0, 50.0));
  EXPECT_TRUE(seen(-1.29, 0.49, 50.0));
  EXPECT_FALSE(seen(0.0, 0.51, 50.0));
  EXPECT_TRUE(seen(0.3, 0.0, 199.0));
  EXPECT_FALSE(seen(0.3, 0.0, 201.0));
}

TEST(Ground, BelowACarTheTargetAppearsUnderTheRoad) {
  Ahead e;
  e.effects.multipath.ground_bounce = true;
  Body& car = e.add_obstacle(20.0, 0.0);
  car.clearance_m = 0.3;
  car.length_m = 2.0;  // the ground path is below 3 cm there
  const Measured m = measure(e);
  ASSERT_EQ(m.count(), 1u);
  EXPECT_NEAR(m.scan->elevation_rad[0], -std::atan2(1.2, 40.0), 1e-6);
  EXPECT_NEAR(m.scan->range_m[0], std::hypot(40.0, 1.2), 1e-5);
  EXPECT_NEAR(m.scan->range_rate_mps[0], -20.0 * 40.0 / std::hypot(40.0, 1.2), 1e-5);
  EXPECT_EQ(m.truth[0].provenance, Provenance::kStationary);
  car.clearance_m = 0.01;
  EXPECT_EQ(measure(e).count(), 0u);
}

TEST(Ground, InterferenceIsBoundedByTheTwoRaysAndAveragesOut) {
  double sum = 0.0, least = 1e9, most = -1e9;
  constexpr int kSamples = 4000;
  for (int i = 0; i < kSamples; ++i) {
    const double distance = 30.0 + 0.005 * i;
    const radar::GroundEffect effect = radar::two_rays(distance, 0.6, 0.7);
    const double reflection = radar::ground_reflection(1.3 / std::hypot(distance, 1.3));
    ASSERT_LE(effect.gain_db, 20.0 * std::log10(1.0 + reflection) + 1e-9);
    ASSERT_GE(effect.gain_db, 20.0 * std::log10(1.0 - reflection) - 1e-9);
    sum += std::pow(10.0, 0.1 * effect.gain_db);
    least = std::min(least, effect.gain_db);
    most = std::max(most, effect.gain_db);
  }
  EXPECT_GT(most - least, 5.0);
  // Mean power of two incoherent rays.
  EXPECT_NEAR(sum / kSamples, 1.0 + 0.4 * 0.4, 0.05);
}

TEST(Ground, AtAMaximumTheApparentElevationLiesBetweenTheRaysAndAtAMinimumAbove) {
  // Rays in phase: weights 1 and ρ; in antiphase: 1 and −ρ (glint beyond the target, away from the mirror image).
  bool between = false, above = false;
  for (double distance = 30.0; distance < 34.0; distance += 0.002) {
    const radar::GroundEffect effect = radar::two_rays(distance, 0.6, 0.7);
    const double upper = std::atan2(0.1, distance), lower = -std::atan2(1.3, distance);
    const double reflection = radar::ground_reflection(1.3 / std::hypot(distance, 1.3));
    if (effect.gain_db > 20.0 * std::log10(1.0 + reflection) - 0.01) {
      between = true;
      EXPECT_NEAR(effect.elevation_rad, upper + reflection / (1.0 + reflection) * (lower - upper), 1e-3);
    }
    if (effect.gain_db < 20.0 * std::log10(1.0 - reflection) + 0.01) {
      above = true;
      EXPECT_NEAR(effect.elevation_rad, upper - reflection / (1.0 - reflection) * (lower - upper), 1e-3);
    }
  }
  EXPECT_TRUE(between && above);
}

}  // namespace
}  // namespace boresight::simulator
