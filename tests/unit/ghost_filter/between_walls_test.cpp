// Ways by one wall and then by another: found as the shortest way that touches both.
#include "services/ghost_filter/core/mirror/between_walls.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

Mirror wall(const Eigen::Vector2d& at, double heading, double half_length) {
  Mirror m;
  m.curve = {at, {std::cos(heading), std::sin(heading)}, 0.0};
  m.covariance = Eigen::Vector3d(0.01, 1e-6, 1e-9).asDiagonal();
  m.begin_m = -half_length;
  m.end_m = half_length;
  m.existence = 1.0;
  return m;
}

/// By Fermat's principle the wave takes it: the least length, found by turns along either wall.
double shortest_way(const Mirror& first, const Mirror& second, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                    double& at_first, double& at_second) {
  at_first = at_second = 0.0;
  const auto length = [&](double a, double b) {
    return (first.curve.at(a) - from).norm() + (second.curve.at(b) - first.curve.at(a)).norm() +
           (to - second.curve.at(b)).norm();
  };
  for (int round = 0; round < 80; ++round) {
    for (double* const place : {&at_first, &at_second}) {
      double low = -200.0, high = 200.0;
      for (int k = 0; k < 60; ++k) {
        const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
        *place = a;
        const double left = length(at_first, at_second);
        *place = b;
        (left < length(at_first, at_second) ? high : low) = left < length(at_first, at_second) ? b : a;
      }
    }
  }
  return length(at_first, at_second);
}

TEST(BetweenWalls, TheWayFoundIsTheShortestThatTouchesBoth) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> tilt(-0.05, 0.05), away(3.0, 15.0), x(-15.0, 15.0), y(-2.5, 2.5);
  const Eigen::Vector2d sensor(3.6, 0.7);
  std::size_t found = 0, beyond = 0;
  for (int run = 0; run < 300; ++run) {
    const Mirror left = wall({0.0, away(random)}, tilt(random), run % 3 == 0 ? 4.0 : 100.0);
    const Mirror right = wall({0.0, -away(random)}, tilt(random), 100.0);
    const Eigen::Vector2d target = sensor + Eigen::Vector2d(x(random), y(random));
    if ((target - sensor).norm() < 0.5) continue;
    double at_left = 0.0, at_right = 0.0;
    const double out = shortest_way(left, right, sensor, target, at_left, at_right);
    const double back = (target - sensor).norm();
    const auto met = WaysBetween(left, right, sensor).meet((target - sensor) / back, out + back);
    if (std::abs(at_left) > left.end_m + 3.0) {
      EXPECT_FALSE(met) << "where there is no wall";
      ++beyond;
    }
    if (std::abs(at_left) > left.end_m) continue;
    ASSERT_TRUE(met) << "run " << run;
    ++found;
    EXPECT_NEAR(met->rest_m, back, 1e-4);
    EXPECT_NEAR((met->point_m - right.curve.at(at_right)).norm(), 0.0, 1e-2);
    EXPECT_NEAR(met->departure.dot((left.curve.at(at_left) - sensor).normalized()), 1.0, 1e-6);
    EXPECT_NEAR(met->arrival.dot((target - right.curve.at(at_right)).normalized()), 1.0, 1e-6);
    EXPECT_GT(met->probability, 0.4);
    EXPECT_NEAR(met->length_std_m, 0.1 * 2.0 * std::sqrt(2.0), 0.15);
    if (met->metres_per_m > 20.0) continue;  // the wave comes from where the ray goes: no length tells the place
    // As the length grows, so goes the place.
    const auto longer = WaysBetween(left, right, sensor).meet((target - sensor) / back, out + back + 1e-4);
    ASSERT_TRUE(longer);
    EXPECT_NEAR((longer->rest_m - met->rest_m) / 1e-4, met->metres_per_m, 1e-2 * met->metres_per_m);
  }
  EXPECT_GT(found, 150U);
  EXPECT_GT(beyond, 5U);
}

TEST(BetweenWalls, NoWayGoesWhereItCannot) {
  const Eigen::Vector2d sensor(0.0, 0.0), abeam(0.0, 1.0);
  const Mirror left = wall({0.0, 6.0}, 0.0, 50.0), right = wall({0.0, -10.0}, 0.0, 50.0);
  const Mirror before = wall({0.0, 8.0}, 0.0, 50.0);
  // 6 up, 16 down, 13 up to what is 3 m away, and 3 back.
  ASSERT_TRUE(WaysBetween(left, right, sensor).meet(abeam, 38.0));
  EXPECT_NEAR(WaysBetween(left, right, sensor).meet(abeam, 38.0)->rest_m, 3.0, 1e-9);
  EXPECT_FALSE(WaysBetween(left, right, sensor).meet(abeam, 20.0)) << "shorter than to the walls and back";
  EXPECT_FALSE(WaysBetween(left, left, sensor).meet(abeam, 38.0));
  EXPECT_FALSE(WaysBetween(left, before, sensor).meet(abeam, 38.0)) << "one behind the other";
  // A bent wall is as good as straight where the wave turns, but not far along.
  Mirror bent = right;
  bent.curve.curvature_per_m = 0.002;
  EXPECT_TRUE(WaysBetween(left, bent, sensor).meet(abeam, 38.0));
  EXPECT_FALSE(WaysBetween(left, bent, sensor).meet(Eigen::Vector2d(0.95, 0.3122499).normalized(), 120.0));
}

}  // namespace
}  // namespace boresight::ghosts
