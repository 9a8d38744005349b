// Wheels turn with other range rates than their vehicle's, which must not change its speed.
#include "services/tracker/core/wheels.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

/// By how much a last detection, whose range rate is that much more than the body's, makes a car faster.
double faster_by(double more_mps) {
  return changed_by_last_scan(
      [more_mps](Scene& scene, int i, bool is_last) {
        scene.add({20.0 + 0.5 * i, 3.0}, {10.0, 0.0});
        if (is_last) scene.scan->range_rate_over_ground_mps[0] += static_cast<float>(more_mps);
      },
      [](const Track& track) { return track.velocity_over_ground_mps[0]; });
}

}  // namespace

TEST(Wheels, OneWheelMakesNothingFaster) {
  const double of_noise = faster_by(0.5) - faster_by(0.0), of_wheel = faster_by(1.5) - faster_by(0.0);
  EXPECT_GT(of_noise, 0.0);
  EXPECT_LT(of_wheel, of_noise);
}

TEST(Wheels, AreTheLikelierTheFartherTheRangeRateIsOff) {
  KinematicState state;
  state.mean.setZero();
  state.mean(2) = 10.0;
  state.covariance.setIdentity();
  PositionRate measurement;
  measurement.line_of_sight = {1.0, 0.0};
  measurement.covariance.setIdentity();
  double before = 1.0;
  for (double off_mps = 0.0; off_mps < 30.0; off_mps += 1.0) {
    measurement.value << 0.0, 0.0, 10.0 + off_mps;
    const double body = chance_of_body(state, measurement);
    EXPECT_LE(body, before);
    EXPECT_GT(body, 0.0);
    before = body;
  }
  EXPECT_LT(before, 0.01);
  measurement.value << 0.0, 0.0, 10.0;
  EXPECT_GT(chance_of_body(state, measurement), 0.7);
}

/// What a radar sees of a van that drives alongside at that speed: its flank from end to end, and a wheel of it.
Cluster seen_alongside(double speed_mps, const Eigen::Vector2d& sensor_m) {
  Cluster cluster{};
  cluster.realness = 1.0;
  cluster.mean_sight.setZero();
  for (const double x : {-1.5, 0.5, 2.5, 4.5, 6.5}) {
    const Eigen::Vector2d at(x, 2.7);
    const Eigen::Vector2d sight = (at - sensor_m).normalized();
    cluster.mean_sight += 0.2 * sight;
    cluster.outline_rate_mps[cluster.number_on_outline] = sight.x() * speed_mps;
    cluster.outline[cluster.number_on_outline++] = at;
  }
  cluster.outline[cluster.number_on_outline] = {1.5, 2.7};
  cluster.outline_rate_mps[cluster.number_on_outline++] = -0.8 * speed_mps;
  return cluster;
}

TEST(Wheels, RangeRatesOneByOneSayHowFastItIsWhoseMeanSaysNothing) {
  const Eigen::Vector2d sensor(2.5, 0.0);
  const Cluster cluster = seen_alongside(10.0, sensor);
  ASSERT_TRUE(is_seen_all_round(cluster));
  ASSERT_LT(std::abs(cluster.mean_sight.x()), 0.01) << "all of it goes across the mean line of sight";
  KinematicState van;
  van.mean << 2.5, 3.6, 12.0, 0.0, 0.0, 0.0;
  van.covariance.setIdentity();
  van.covariance(2, 2) = 4.0;
  follow_rates(van, cluster, sensor);
  EXPECT_NEAR(van.mean(2), 10.0, 0.3);
  EXPECT_LT(van.covariance(2, 2), 0.1);
  EXPECT_GT(van.covariance(2, 2), 0.3 * 0.3 / 5.0) << "no surer than five detections are";
  EXPECT_NEAR(van.mean(3), 0.0, 0.5);
}

TEST(Wheels, WhatIsFarAwayIsSeenFromOneSideOnly) {
  EXPECT_FALSE(is_seen_all_round(seen_alongside(10.0, {-60.0, 0.0})));
}

TEST(Wheels, OneRangeRateIsNotSeenAllRoundWhereverGhostsAre) {
  Cluster cluster = seen_alongside(10.0, {2.5, 0.0});
  cluster.number_on_outline = 2;
  EXPECT_TRUE(is_seen_all_round(cluster));
  cluster.number_on_outline = 1;
  EXPECT_FALSE(is_seen_all_round(cluster));
}

/// A van's speed after many looks at its middle and at a wheel house ahead of it, whose range rate is any that a wheel
/// shows; the van drives at 6 m/s and was thought to drive at 7.
double followed_speed(double body_dbsm, double wheel_dbsm) {
  const Eigen::Vector2d sensor(3.6, 0.8);
  KinematicState van;
  van.mean << 4.4, 3.6, 7.0, 0.0, 0.0, 0.0;
  van.covariance.setIdentity();
  van.covariance(3, 3) = 0.01;
  for (const double turned : {1.8, 0.1, 1.2, 0.6, 0.3, 1.6, 0.2, 0.9}) {
    Cluster cluster{};
    cluster.realness = 1.0;
    cluster.number_on_outline = 2;
    cluster.mean_sight.setZero();
    cluster.outline = {Eigen::Vector2d(6.4, 2.6), Eigen::Vector2d(4.5, 2.6)};
    cluster.outline_dbsm = {wheel_dbsm, body_dbsm};
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Vector2d sight = (cluster.outline[k] - sensor).normalized();
      cluster.mean_sight += 0.5 * sight;
      cluster.outline_rate_mps[k] = sight.x() * 6.0 * (k == 0 ? turned : 1.0);
    }
    EXPECT_TRUE(is_seen_all_round(cluster));
    follow_rates(van, cluster, sensor);
    van.covariance(2, 2) += 0.05;
  }
  return van.mean(2);
}

TEST(Wheels, OfTwoRangeRatesTheStrongerOnesIsTheBodys) {
  const double by_strength = std::abs(followed_speed(8.0, -6.0) - 6.0);
  EXPECT_LT(by_strength, 0.3);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LT(by_strength, std::abs(followed_speed(kNone, kNone) - 6.0)) << "without strength wheels pull it";
}

}  // namespace boresight::tracking
