// Path and collision: limits, symmetries, and the probability against random draws.
#include <random>

#include <gtest/gtest.h>

#include "services/tracker/core/surroundings/collision.hpp"

namespace boresight::tracking {
namespace {

TEST(EgoPath, PlacesLieOnTheCircle) {
  const EgoPath path = ego_path(10.0, 0.2, 0.0, 0.0, 1.0);  // radius 50 m
  for (const double along : {-10.0, 0.0, 5.0, 40.0}) {
    for (const double aside : {-3.0, 0.0, 4.0}) {
      const double angle = along / 50.0, radius = 50.0 - aside;
      const PathPlace place = path.place({radius * std::sin(angle), 50.0 - radius * std::cos(angle)});
      EXPECT_NEAR(place.along_m, along, 1e-9);
      EXPECT_NEAR(place.aside_m, aside, 1e-9);
    }
  }
}

TEST(EgoPath, StraightLineIsTheLimitOfTheCircle) {
  const Eigen::Vector2d p(40.0, 1.5);
  for (const double yaw_rate : {0.0, 1e-12, 1e-9, -1e-9}) {
    const PathPlace place = ego_path(15.0, yaw_rate, 0.0, 0.0, 1.0).place(p);
    EXPECT_NEAR(place.along_m, 40.0, 1e-6) << yaw_rate;
    EXPECT_NEAR(place.aside_m, 1.5, 1e-6) << yaw_rate;
  }
  EXPECT_EQ(ego_path(0.5, 0.3, 0.0, 0.0, 1.0).curvature_per_m, 0.0) << "no circle of a vehicle that hardly drives";
  EXPECT_EQ(ego_path(0.0, 0.0, 0.0, 0.0, 1.0).place(p).aside_m, 1.5);
}

MeetingObject standing_car(double x_m, double y_m) {
  MeetingObject car;
  car.position_m = {x_m, y_m};
  car.length_m = 4.0;
  car.width_m = 1.8;
  car.covariance.topLeftCorner<2, 2>() = 0.09 * Eigen::Matrix2d::Identity();
  return car;
}

TEST(Meeting, StandingCarAheadIsReachedAfterTheGap) {
  const CollisionParameters c;
  const Meeting m = meeting(standing_car(40.0, 0.0), ego_path(15.0, 0.0, 0.1, 0.0, 1.0), c);
  ASSERT_TRUE(m.is_ahead);
  const double gap_m = 40.0 - 2.0 - c.front_m;
  EXPECT_NEAR(m.time_s, gap_m / 15.0, 1e-9);
  EXPECT_NEAR(m.time_std_s, std::hypot(0.3, 0.1 * m.time_s) / 15.0, 1e-9);
  EXPECT_NEAR(m.deceleration_mps2, 15.0 * 15.0 / (2.0 * gap_m), 1e-9);
  EXPECT_GT(m.probability, 0.85);
}

TEST(Meeting, IsMirroredWithTheWorld) {
  const CollisionParameters c;
  MeetingObject left = standing_car(30.0, 2.0);
  left.velocity_mps = {0.0, -1.0};
  left.covariance(0, 1) = left.covariance(1, 0) = 0.02;
  left.heading_rad = 0.4;
  MeetingObject right = left;
  right.position_m.y() = -2.0;
  right.velocity_mps.y() = 1.0;
  right.covariance(0, 1) = right.covariance(1, 0) = -0.02;
  right.heading_rad = -0.4;
  const Meeting a = meeting(left, ego_path(10.0, 0.05, 0.1, 0.01, 1.0), c);
  const Meeting b = meeting(right, ego_path(10.0, -0.05, 0.1, 0.01, 1.0), c);
  EXPECT_NEAR(a.time_s, b.time_s, 1e-12);
  EXPECT_NEAR(a.offset_m, -b.offset_m, 1e-12);
  EXPECT_NEAR(a.probability, b.probability, 1e-12);
}

TEST(Meeting, OnACircleIsThatOfTheStraightRoadAlongIt) {
  const CollisionParameters c;
  const double radius_m = 60.0, along_m = 35.0;
  MeetingObject car =
      standing_car(radius_m * std::sin(along_m / radius_m), radius_m - radius_m * std::cos(along_m / radius_m));
  car.heading_rad = along_m / radius_m;
  const Meeting bent = meeting(car, ego_path(12.0, 12.0 / radius_m, 0.1, 0.0, 1.0), c);
  const Meeting straight = meeting(standing_car(along_m, 0.0), ego_path(12.0, 0.0, 0.1, 0.0, 1.0), c);
  EXPECT_NEAR(bent.time_s, straight.time_s, 1e-9);
  EXPECT_NEAR(bent.probability, straight.probability, 1e-9);
}

TEST(Meeting, NeverComesIfTheyDoNotApproach) {
  const CollisionParameters c;
  MeetingObject faster = standing_car(20.0, 0.0);
  faster.velocity_mps = {16.0, 0.0};
  EXPECT_TRUE(std::isinf(meeting(faster, ego_path(15.0, 0.0, 0.1, 0.0, 1.0), c).time_s));
  EXPECT_TRUE(std::isinf(meeting(standing_car(20.0, 0.0), ego_path(0.0, 0.0, 0.1, 0.0, 1.0), c).time_s));
  EXPECT_FALSE(meeting(standing_car(-20.0, 0.0), ego_path(15.0, 0.0, 0.1, 0.0, 1.0), c).is_ahead);
}

TEST(Meeting, ProbabilityIsTheShareOfRandomDrawsThatMeet) {
  const CollisionParameters c;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (const double start_m : {-5.0, -3.5, -1.0}) {
    MeetingObject person;
    person.position_m = {25.0, start_m};
    person.velocity_mps = {0.0, 1.4};
    person.length_m = person.width_m = 0.6;
    person.covariance.diagonal() << 0.04, 0.04, 0.04, 0.09;
    const EgoPath path = ego_path(10.0, 0.0, 0.0, 0.004, 1.0);
    const Meeting m = meeting(person, path, c);
    int met = 0;
    constexpr int kDraws = 20000;
    for (int i = 0; i < kDraws; ++i) {
      const double x = 25.0 + 0.2 * normal(random), y = start_m + 0.2 * normal(random);
      const double vy = 1.4 + 0.3 * normal(random), vx = 0.2 * normal(random);
      const double time_s = (x - 0.3 - c.front_m) / (10.0 - vx);
      const double path_m = std::sqrt(path.variance_m2(time_s, c.lateral_jerk_density_m2ps5)) * normal(random);
      met += std::abs(y + vy * time_s - path_m) < 0.5 * (c.width_m + 0.6) ? 1 : 0;
    }
    EXPECT_NEAR(m.probability, static_cast<double>(met) / kDraws, 0.02) << start_m;
  }
}

TEST(Meeting, PathSpreadIsThatOfRandomSteering) {
  // Lateral jerk is white: simulated in steps of a millisecond.
  const EgoPath path = ego_path(10.0, 0.0, 0.0, 0.0, 1.0);
  const double density = 0.3, time_s = 2.0, step_s = 2e-3;
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  double squares = 0.0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    double a = 0.0, v = 0.0, y = 0.0;
    for (double t = 0.0; t < time_s; t += step_s) {
      y += v * step_s;
      v += a * step_s;
      a += std::sqrt(density * step_s) * normal(random);
    }
    squares += y * y;
  }
  EXPECT_NEAR(squares / kDraws, path.variance_m2(time_s, density), 0.1 * path.variance_m2(time_s, density));
}

}  // namespace
}  // namespace boresight::tracking
