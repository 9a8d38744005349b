// Paths by mirrors agree with examples derived by hand (mirrored positions) or by another method (shortest path).
#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/simulator/radar/bench_scene.hpp"

namespace boresight::simulator {
namespace {

using testing::SizeIs;

/// Sensor at (0, 0) with 20 m/s along x, target at (30, 1) with (25, 0.5) m/s, rail along y = 4. The mirror image of
/// the target is at (30, 7) and moves with (25, −0.5) m/s. The specular point is at x = 30·4/7.
struct RailExample : Bench {
  RailExample() {
    add_rail({0.0, 4.0}, {100.0, 4.0});
    add_body(9, {30.0, 1.0, kHeight_m}, {25.0, 0.5, 0.0});
  }
  /// Lengths of the direct path and of that by the rail after `t_s`.
  static std::pair<double, double> lengths(double t_s) {
    const double x = 30.0 + (25.0 - 20.0) * t_s, y = 1.0 + 0.5 * t_s;
    return {std::hypot(x, y), std::hypot(x, 8.0 - y)};
  }
};

TEST(Multipath, AStraightRailMakesBothTypesOfGhosts) {
  const Measured m = measure(RailExample());
  const auto [direct, detour] = RailExample::lengths(0.0);
  const auto [direct1, detour1] = RailExample::lengths(1e-4);
  const auto [direct0, detour0] = RailExample::lengths(-1e-4);
  const double direct_rate = (direct1 - direct0) / 2e-4, detour_rate = (detour1 - detour0) / 2e-4;
  ASSERT_EQ(m.count(), 4u);

  struct Expected {
    Provenance provenance;
    unsigned bounces;
    double range, azimuth, rate;
  };
  for (const Expected& e : {Expected{Provenance::kMoving, 0, direct, std::atan2(1.0, 30.0), direct_rate},
                            Expected{Provenance::kGhostType1, 1, 0.5 * (direct + detour), std::atan2(1.0, 30.0),
                                     0.5 * (direct_rate + detour_rate)},
                            Expected{Provenance::kGhostType2, 1, 0.5 * (direct + detour), std::atan2(7.0, 30.0),
                                     0.5 * (direct_rate + detour_rate)},
                            Expected{Provenance::kGhostType2, 2, detour, std::atan2(7.0, 30.0), detour_rate}}) {
    const auto found = m.of(e.provenance, e.bounces);
    ASSERT_THAT(found, SizeIs(1));
    EXPECT_NEAR(m.scan->range_m[found[0]], e.range, 1e-4);
    EXPECT_NEAR(m.scan->azimuth_rad[found[0]], e.azimuth, 1e-6);
    EXPECT_NEAR(m.scan->elevation_rad[found[0]], 0.0, 1e-6);
    EXPECT_NEAR(m.scan->range_rate_mps[found[0]], e.rate, 1e-4);
    EXPECT_EQ(m.truth[found[0]].object_id, 9u);
  }
}

TEST(Multipath, EveryBounceCostsTheSurfacesLossAndTheDetourItsSpreading) {
  RailExample e;
  const Measured cheap = measure(e);
  e.scene.surfaces[0].loss_db += 5.0;
  const Measured dear = measure(e);
  for (const auto& [provenance, bounces] :
       {std::pair{Provenance::kMoving, 0u}, {Provenance::kGhostType1, 1u}, {Provenance::kGhostType2, 2u}}) {
    EXPECT_FLOAT_EQ(
        cheap.scan->rcs_dbsm[cheap.of(provenance, bounces)[0]] - dear.scan->rcs_dbsm[dear.of(provenance, bounces)[0]],
        5.0F * static_cast<float>(bounces));
  }
  // The ghost has the RCS of a 10 dBsm target at its range, less twice 3 dB: the sensor corrects for the spreading.
  EXPECT_FLOAT_EQ(cheap.scan->rcs_dbsm[cheap.of(Provenance::kGhostType2, 2)[0]], 4.0F);
  e.effects.multipath.extra_loss_db = 2.0;
  const Measured extra = measure(e);
  EXPECT_FLOAT_EQ(dear.scan->rcs_dbsm[dear.of(Provenance::kGhostType2, 2)[0]] -
                      extra.scan->rcs_dbsm[extra.of(Provenance::kGhostType2, 2)[0]],
                  4.0F);
  EXPECT_DOUBLE_EQ(radar::radar_equation_db(10.0, 10.0, 10.0), 10.0);
  EXPECT_NEAR(radar::radar_equation_db(0.0, 20.0, 20.0), -12.04, 0.01);
  EXPECT_NEAR(radar::radar_equation_db(0.0, 10.0, 20.0), -6.02, 0.01);
}

TEST(Multipath, ACornerReflectsMostlyBackToTheSource) {
  RailExample e;
  const auto rcs = [](const Measured& m, Provenance provenance, unsigned bounces) {
    return m.scan->rcs_dbsm[m.of(provenance, bounces)[0]];
  };
  e.effects.multipath.bistatic_rad = 0.0;
  const Measured everywhere = measure(e);
  // Angle at the target between incident and reflected path: atan(1/30) + atan(7/30) = 0.2625.
  e.effects.multipath.bistatic_rad = 0.13125;
  const Measured corner = measure(e);
  EXPECT_NEAR(rcs(everywhere, Provenance::kGhostType1, 1) - rcs(corner, Provenance::kGhostType1, 1), 12.0, 1.01);
  EXPECT_NEAR(rcs(everywhere, Provenance::kGhostType2, 1) - rcs(corner, Provenance::kGhostType2, 1), 12.0, 1.01);
  EXPECT_FLOAT_EQ(rcs(everywhere, Provenance::kGhostType2, 2), rcs(corner, Provenance::kGhostType2, 2));
  EXPECT_FLOAT_EQ(rcs(everywhere, Provenance::kMoving, 0), rcs(corner, Provenance::kMoving, 0));
}

TEST(Multipath, ThereIsNoGhostThroughAGapInTheRail) {
  RailExample e;  // the specular point is at x = 17.143
  e.scene.surfaces.clear();
  e.add_rail({0.0, 4.0}, {17.0, 4.0});
  e.add_rail({17.3, 4.0}, {100.0, 4.0});
  EXPECT_EQ(measure(e).count(), 1u);
  e.scene.surfaces[0].to_m.x() = 17.15;
  EXPECT_EQ(measure(e).count(), 4u);
}

TEST(Multipath, TheBounceMustLieWithinTheRailsHeights) {
  RailExample e;
  e.scene.centres[0].position_m.z() = 1.2;  // the specular point is at z = 0.6 + 4/7·0.6 = 0.943
  EXPECT_EQ(measure(e).count(), 1u);
  e.scene.surfaces[0].high_m = 0.95;
  EXPECT_EQ(measure(e).count(), 4u);
  e.scene.surfaces[0].low_m = 0.945;
  EXPECT_EQ(measure(e).count(), 1u);
}

TEST(Multipath, AnOccludedTargetIsDetectedByItsGhostOnly) {
  RailExample e;
  e.add_body(2, {15.0, 0.5, kHeight_m}, {0.0, 0.0, 0.0});
  e.scene.bodies.back().parked = true;
  e.scene.bodies.back().number_of_centres = 0;
  const Measured m = measure(e);
  EXPECT_THAT(m.of(Provenance::kGhostType2, 2), SizeIs(1));
  EXPECT_EQ(m.count(), 1u);
  e.scene.bodies.back().position_m = {17.0, 3.5};  // hides the specular point instead
  EXPECT_EQ(measure(e).of(Provenance::kMoving), 1u);
  EXPECT_EQ(measure(e).count(), 1u);
}

TEST(Multipath, ASideThatFacesTheRailIsDetectedByTheRailOnly) {
  RailExample e;
  e.scene.centres[0].facing = {0.0, 1.0, 0.0};
  const Measured m = measure(e);
  EXPECT_EQ(m.count(), 1u);
  EXPECT_THAT(m.of(Provenance::kGhostType2, 2), SizeIs(1));
}

TEST(Multipath, FewerBouncesMakeFewerGhosts) {
  RailExample e;
  e.effects.multipath.max_bounces = 2;
  Measured m = measure(e);
  EXPECT_EQ(m.count(), 3u);
  EXPECT_THAT(m.of(Provenance::kGhostType2, 2), SizeIs(0));
  e.effects.multipath.max_bounces = 1;
  EXPECT_EQ(measure(e).count(), 1u);
  e.effects.multipath.max_bounces = 3;
  e.effects.multipath.on = false;
  EXPECT_EQ(measure(e).count(), 1u);
}

TEST(Multipath, StationaryTargetsAreMirroredOnRequest) {
  RailExample e;
  e.scene.bodies[0].parked = true;
  e.scene.centres[0].velocity_mps.setZero();
  EXPECT_EQ(measure(e).count(), 1u);
  e.effects.multipath.of_stationary = true;
  const Measured m = measure(e);
  EXPECT_EQ(m.count(), 4u);
  // A stationary target in a stationary mirror has the range rate of a stationary target at the ghost's place.
  const std::size_t i = m.of(Provenance::kGhostType2, 2)[0];
  EXPECT_NEAR(m.scan->range_rate_mps[i], -20.0 * std::cos(m.scan->azimuth_rad[i]), 1e-4);
}

TEST(Multipath, TwoRailsMakeThePathsByBoth) {
  RailExample e;
  e.add_rail({0.0, -5.0}, {100.0, -5.0});
  const Measured m = measure(e);
  // Mirror images: left rail (30, 7); right rail (30, −11); first right at −5, to −11, then left at 4, to (30, 19);
  // first left at 4, to 7, then right at −5, to (30, −17).
  const double direct = std::hypot(30.0, 1.0), left = std::hypot(30.0, 7.0), right = std::hypot(30.0, 11.0);
  const double both_left = std::hypot(30.0, 19.0), both_right = std::hypot(30.0, 17.0);
  std::vector<std::pair<double, double>> expected = {
      {left, 7.0},
      {right, -11.0},  // three bounces by one rail
      {0.5 * (left + right), 7.0},
      {0.5 * (left + right), -11.0},  // out by one rail, back by the other
      {0.5 * (direct + both_left), 19.0},
      {0.5 * (direct + both_right), -17.0}  // both on the way back
  };
  const auto found = m.of(Provenance::kGhostType2, 2);
  ASSERT_THAT(found, SizeIs(expected.size()));
  for (const auto& [range, lateral] : expected) {
    const auto matches = [&, r = range, y = lateral](std::size_t i) {
      return std::abs(m.scan->range_m[i] - r) < 1e-3 && std::abs(m.scan->azimuth_rad[i] - std::atan2(y, 30.0)) < 1e-5;
    };
    EXPECT_EQ(std::count_if(found.begin(), found.end(), matches), 1) << range << " " << lateral;
  }
  EXPECT_THAT(m.of(Provenance::kGhostType1, 2), SizeIs(2));
  EXPECT_THAT(m.of(Provenance::kGhostType1, 1), SizeIs(2));
}

/// A truck in a bend; its right side (y = −1.25 in its axes) mirrors.
struct TruckExample : Bench {
  TruckExample() {
    Body& truck = add_body(5, {20.0, 6.0, 2.0}, {22.0, -1.5, 0.0});
    truck.kind = BodyKind::kTruck;
    truck.length_m = 16.0;
    truck.width_m = 2.5;
    truck.height_m = 4.0;
    truck.clearance_m = 0.3;
    truck.heading_rad = -0.05;
    truck.yaw_rate_radps = 0.2;
    truck.number_of_centres = 0;
    scene.surfaces.push_back({side_end(0.0, -8.0), side_end(0.0, 8.0), 0.5, 3.5, 2.0, {22.0, -1.5}, 5, true});
    add_body(9, {32.0, -1.0, 0.8}, {15.0, 1.0, 0.0});
  }
  static Eigen::Vector2d side_end(double t_s, double along) {
    const double heading = -0.05 + 0.2 * t_s;
    const Eigen::Vector2d forward(std::cos(heading), std::sin(heading)), left(-forward.y(), forward.x());
    return Eigen::Vector2d(20.0 + 22.0 * t_s, 6.0 - 1.5 * t_s) + along * forward - 1.25 * left;
  }
  /// Shortest path from the sensor over the truck's side to the target by golden section (Fermat's principle).
  static double shortest(double t_s) {
    const Eigen::Vector2d sensor(20.0 * t_s, 0.0), target(32.0 + 15.0 * t_s, -1.0 + 1.0 * t_s);
    const auto length = [&](double along) {
      const Eigen::Vector2d at = side_end(t_s, along);
      return std::hypot((at - sensor).norm() + (at - target).norm(), 0.8 - kHeight_m);
    };
    double low = -8.0, high = 8.0;
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    for (int i = 0; i < 80; ++i) {
      const double a = high - golden * (high - low), b = low + golden * (high - low);
      (length(a) < length(b) ? high : low) = length(a) < length(b) ? b : a;
    }
    return length(0.5 * (low + high));
  }
};

TEST(Multipath, AMovingTurningTrucksSideChangesTheLengthAsTheShortestPathSays) {
  const TruckExample e;
  const Measured m = measure(e);
  const auto found = m.of(Provenance::kGhostType2, 2);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(m.scan->range_m[found[0]], TruckExample::shortest(0.0), 1e-4);
  const double rate = (TruckExample::shortest(1e-3) - TruckExample::shortest(-1e-3)) / 2e-3;
  EXPECT_NEAR(m.scan->range_rate_mps[found[0]], rate, 2e-4);
  EXPECT_EQ(m.truth[found[0]].mirror_body, 5u);
  EXPECT_EQ(m.truth[found[0]].object_id, 9u);
  // A stationary mirror at this place would give another rate.
  TruckExample standing;
  standing.scene.bodies[0].velocity_mps.setZero();
  standing.scene.bodies[0].yaw_rate_radps = 0.0;
  const Measured s = measure(standing);
  EXPECT_GT(std::abs(s.scan->range_rate_mps[s.of(Provenance::kGhostType2, 2)[0]] - rate), 0.5);
}

TEST(Multipath, ATruckMirrorsOnItsOutsideOnlyAndNotItself) {
  TruckExample e;
  e.scene.bodies[0].position_m.y() -= 2.5;  // the same plane is now the inner face of the truck's left side
  EXPECT_EQ(measure(e).of(Provenance::kGhostType2), 0u);
  TruckExample self;
  self.scene.surfaces[0].body_id = 9;
  self.scene.bodies[1].position_m.y() = 10.0;  // its body lies behind the mirroring side
  EXPECT_EQ(measure(self).of(Provenance::kGhostType2), 0u);
}

TEST(Multipath, ATurnedWorldSeesTheSameGeometry) {
  // The whole example, rotated by 1.1 rad about the origin, gives the same measurement.
  RailExample e;
  const Eigen::Rotation2Dd turn(1.1);
  e.scene.ego.heading_rad = 1.1;
  for (MirrorSurface& s : e.scene.surfaces) {
    s.from_m = turn * s.from_m;
    s.to_m = turn * s.to_m;
  }
  e.scene.bodies[0].position_m = turn * e.scene.bodies[0].position_m;
  e.scene.bodies[0].velocity_mps = turn * e.scene.bodies[0].velocity_mps;
  e.scene.bodies[0].heading_rad += 1.1;
  e.scene.centres[0].position_m.head<2>() = turn * Eigen::Vector2d(e.scene.centres[0].position_m.head<2>());
  e.scene.centres[0].velocity_mps.head<2>() = turn * Eigen::Vector2d(e.scene.centres[0].velocity_mps.head<2>());
  const Measured a = measure(RailExample()), b = measure(e);
  ASSERT_EQ(a.count(), b.count());
  for (const auto& [provenance, bounces] : {std::pair{Provenance::kMoving, 0u},
                                            {Provenance::kGhostType1, 1u},
                                            {Provenance::kGhostType2, 1u},
                                            {Provenance::kGhostType2, 2u}}) {
    const std::size_t i = a.of(provenance, bounces).at(0), k = b.of(provenance, bounces).at(0);
    EXPECT_NEAR(a.scan->range_m[i], b.scan->range_m[k], 1e-4);
    EXPECT_NEAR(a.scan->azimuth_rad[i], b.scan->azimuth_rad[k], 1e-5);
    EXPECT_NEAR(a.scan->range_rate_mps[i], b.scan->range_rate_mps[k], 1e-4);
  }
}

}  // namespace
}  // namespace boresight::simulator
