// Roads and motions agree with their own derivatives.
#include "services/simulator/world/motion.hpp"

#include <gtest/gtest.h>

#include "services/simulator/world/knots.hpp"

namespace boresight::simulator {
namespace {

constexpr double kStep = 1e-4;

TEST(Knots, AreSmoothAndTheirIntegralIsTheirArea) {
  const Knots knots{{-2.0, 3.0}, {1.0, -1.0}, {4.0, 5.0}};
  EXPECT_EQ(smooth(knots, -10.0).value, 3.0);
  EXPECT_EQ(smooth(knots, 10.0).value, 5.0);
  EXPECT_EQ(smooth(knots, 1.0).value, -1.0);
  double area = 0.0;
  for (double x = -3.0; x < 6.0; x += 0.01) {
    const Smooth s = smooth(knots, x), a = smooth(knots, x - kStep), b = smooth(knots, x + kStep);
    ASSERT_NEAR(s.slope, (b.value - a.value) / (2.0 * kStep), 1e-5) << x;
    ASSERT_NEAR(s.curvature, (b.slope - a.slope) / (2.0 * kStep), 1e-2) << x;
    area += 0.01 * smooth(knots, x + 0.005).value;
    ASSERT_NEAR(integral(knots, x + 0.01) - integral(knots, -3.0), area, 1e-4) << x;
  }
  EXPECT_EQ(integral(knots, 0.0), 0.0);
  EXPECT_LT(integral(knots, -2.0), 0.0);
  EXPECT_EQ(integral({}, 5.0), 0.0);
}

TEST(Road, AQuarterCircleTurnsByNinetyDegrees) {
  const double radius = 30.0, quarter = 0.5 * M_PI * radius;
  const Road road({{{100.0, 0.0}, {quarter, 1.0 / radius}, {100.0, 0.0}}, 1e-3, {}}, -50.0, 300.0);
  EXPECT_NEAR(road.at(-50.0).position_m.x(), -50.0, 1e-9);
  EXPECT_NEAR(road.at(99.0).position_m.y(), 0.0, 1e-9);
  const RoadPoint end = road.at(100.0 + quarter + 10.0);
  // Borders of segments fall between the table's points.
  EXPECT_NEAR(end.heading_rad, 0.5 * M_PI, 0.01);
  EXPECT_NEAR(end.position_m.x(), 130.0, 0.3);
  EXPECT_NEAR(end.position_m.y(), 40.0, 0.3);
  EXPECT_NEAR(road.place(50.0, 3.0).y(), 3.0, 1e-9);
}

TEST(Road, ClothoidsJoinSegmentsOfDifferentCurvature) {
  const RoadSpec spec{{{200.0, 0.0}, {200.0, 0.01}, {20.0, -0.02}, {100.0, 0.0}}, 50.0, {}};
  EXPECT_EQ(curvature_at(spec, 174.9), 0.0);
  EXPECT_NEAR(curvature_at(spec, 200.0), 0.005, 1e-12);
  EXPECT_NEAR(curvature_at(spec, 225.1), 0.01, 1e-12);
  for (double arc = -10.0; arc < 540.0; arc += 0.1) {
    // The steepest: −0.03 over the 20 m of the short segment.
    ASSERT_LE(std::abs(curvature_at(spec, arc + 0.1) - curvature_at(spec, arc)), 0.0025 * 0.1 + 1e-9) << arc;
  }
  EXPECT_NEAR(curvature_at(spec, 1000.0), 0.0, 1e-12);
}

TEST(Road, ItsHeadingIsTheDirectionOfItsLine) {
  const Road road({{{40.0, 0.0}, {60.0, 0.05}, {60.0, -0.1}, {40.0, 0.0}}, 10.0, {{0.006, 80.0}}}, -80.0, 260.0);
  for (double arc = -75.0; arc < 255.0; arc += 0.0731) {
    const Eigen::Vector2d step = road.at(arc + 0.01).position_m - road.at(arc - 0.01).position_m;
    const RoadPoint p = road.at(arc);
    ASSERT_NEAR(step.norm(), 0.02, 2e-6) << arc;
    ASSERT_NEAR(std::remainder(std::atan2(step.y(), step.x()) - p.heading_rad, 2.0 * M_PI), 0.0, 1e-3) << arc;
    ASSERT_NEAR((road.at(arc + 0.01).heading_rad - road.at(arc - 0.01).heading_rad) / 0.02, p.curvature_per_m, 2e-4);
  }
}

/// Velocity, yaw rate and acceleration are those of the positions.
template <typename MotionAt>
void expect_consistent(const MotionAt& at, double end_s) {
  for (double t = 0.05; t < end_s; t += 0.0937) {
    const Motion m = at(t), a = at(t - 1e-3), b = at(t + 1e-3);
    const Eigen::Vector2d velocity = (b.position_m - a.position_m) / 2e-3;
    ASSERT_NEAR((m.velocity_mps() - velocity).norm(), 0.0, 0.01) << t;
    ASSERT_NEAR(m.yaw_rate_radps, (b.heading_rad - a.heading_rad) / 2e-3, 3e-3) << t;
    ASSERT_NEAR(m.acceleration_mps2, (b.speed_mps - a.speed_mps) / 2e-3, 0.05) << t;
    ASSERT_NEAR(m.speed_mps, (b.travelled_m - a.travelled_m) / 2e-3, 3.0) << "but for the lateral offset" << t;
  }
}

TEST(Motion, FollowsTheRoadThroughBendsAndLaneChanges) {
  const Road road({{{50.0, 0.0}, {150.0, 0.02}, {150.0, -0.03}, {300.0, 0.0}}, 30.0, {}}, -500.0, 900.0);
  EgoSpec ego;
  ego.speed_mps = {{0.0, 12.0}, {10.0, 18.0}, {20.0, 4.0}};
  ego.swing_mps = 2.0;
  ego.lateral_m = {{30.0, 0.0}, {80.0, 3.5}, {200.0, 3.5}, {260.0, -3.0}};
  expect_consistent([&](double t) { return ego_motion(ego, road, t); }, 25.0);

  BodySpec oncoming;
  oncoming.start_m = 400.0;
  oncoming.speed_mps = {{0.0, -15.0}, {10.0, -8.0}};
  oncoming.lateral_m = {{100.0, 3.5}, {160.0, 5.0}};
  expect_consistent([&](double t) { return body_motion(oncoming, road, t); }, 25.0);
  EXPECT_GT(body_motion(oncoming, road, 1.0).speed_mps, 0.0) << "the body drives forward, in the opposite direction";

  BodySpec crossing;
  crossing.kind = BodyKind::kPedestrian;
  crossing.start_m = 40.0;
  crossing.lateral_m = {{0.0, 6.0}};
  crossing.heading_rad = -0.5 * M_PI;
  crossing.speed_mps = {{2.0, 0.0}, {3.0, 1.5}};
  expect_consistent([&](double t) { return body_motion(crossing, road, t); }, 12.0);
  EXPECT_NEAR(body_motion(crossing, road, 6.5).lateral_m, 0.0, 1e-9) << "1.5 m/s for 3.5 s, and half of that for one";
  EXPECT_NEAR(body_motion(crossing, road, 6.5).position_m.x(), 40.0, 0.1);
}

TEST(Motion, BackingKeepsTheHeading) {
  const Road road({{{100.0, 0.01}}, 10.0, {}}, -100.0, 200.0);
  EgoSpec ego;
  ego.start_m = 50.0;
  ego.speed_mps = {{0.0, 2.0}, {3.0, 0.0}, {4.0, 0.0}, {6.0, -1.5}};
  expect_consistent([&](double t) { return ego_motion(ego, road, t); }, 12.0);
  const Motion m = ego_motion(ego, road, 10.0);
  EXPECT_NEAR(m.speed_mps, -1.5, 1e-9);
  EXPECT_NEAR(m.heading_rad, road.at(m.arc_m).heading_rad, 1e-9);
  EXPECT_NEAR(m.yaw_rate_radps, -0.015, 1e-9);
  const Gap extent = ego_extent(ego, 20.0);
  EXPECT_LT(extent.from_m, 50.0 + ego_motion(ego, road, 20.0).travelled_m + 0.01);
  EXPECT_NEAR(extent.to_m, 53.0, 0.01);
}

}  // namespace
}  // namespace boresight::simulator
