// A cell's range rates as measurements of its velocity.
#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "services/tracker/core/classical/velocity.hpp"

namespace boresight::tracking::classical {
namespace {

View<double> view(double variance, const Vector2<double>& turn_mps = {0.0, 0.0}) {
  View<double> v;
  v.range_rate_variance = variance;
  v.turn_mps = turn_mps;
  return v;
}

TEST(CellVelocity, BothDirectionsTogetherAreLeastSquaresOfTheRangeRates) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(0.2, 0.9), rate(-8.0, 8.0);
  Cell<double> cell;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int k = 0; k < 5; ++k) {
    const double a = angle(random), r = rate(random);
    Measurement<double> z;
    z.sight = {std::cos(a), std::sin(a)};
    z.range_rate_mps = r;
    cell.add(z, 1.0);
    const Eigen::Vector2d u(z.sight.x, z.sight.y);
    information += u * u.transpose() / 0.04;
    sum += u * r / 0.04;
  }
  const CellVelocity v = cell_velocity(cell, view(0.04));
  ASSERT_TRUE(v.along && v.across);
  // The information of both measurements, as a filter adds them.
  const Eigen::Vector2d e = v.along->line_of_sight;
  const Eigen::Matrix2d second = v.across->covariance.inverse();
  const Eigen::Matrix2d both = e * e.transpose() / v.along->variance_m2ps2 + second;
  const Eigen::Vector2d weighted = e * v.along->mean_mps / v.along->variance_m2ps2 + second * v.across->velocity_mps;
  EXPECT_TRUE(both.isApprox(information, 1e-6));
  EXPECT_TRUE((both.inverse() * weighted).isApprox(information.inverse() * sum, 1e-5));
}

TEST(CellVelocity, OneLineOfSightHasNoAcross) {
  Cell<double> cell;
  Measurement<double> z;
  z.sight = {0.6, 0.8};
  z.range_rate_mps = 4.0;
  cell.add(z, 1.0);
  cell.add(z, 1.0);
  const CellVelocity v = cell_velocity(cell, view(0.04));
  ASSERT_TRUE(v.along);
  EXPECT_FALSE(v.across);
  // An eigenvector has no sign: the rate goes with it.
  EXPECT_NEAR(v.along->mean_mps * v.along->line_of_sight.dot(Eigen::Vector2d(0.6, 0.8)), 4.0, 1e-12);
  EXPECT_NEAR(v.along->variance_m2ps2, 0.02, 1e-12);
}

TEST(CellVelocity, UnknownTurnRateActsAcross) {
  Cell<double> cell;
  for (const double a : {-0.1, 0.1}) {
    Measurement<double> z;
    z.sight = {std::cos(a), std::sin(a)};
    cell.add(z, 1.0);
  }
  const CellVelocity straight = cell_velocity(cell, view(0.04)), turning = cell_velocity(cell, view(0.04, {0.0, 3.0}));
  EXPECT_NEAR(turning.along->variance_m2ps2, straight.along->variance_m2ps2, 1e-9);
  EXPECT_NEAR(turning.across->covariance(1, 1) - straight.across->covariance(1, 1), 9.0, 1e-6);
}

TEST(CellVelocity, RadarWithoutRangeRatesTellsNothing) {
  Cell<double> cell;
  cell.add({}, 1.0);
  EXPECT_FALSE(cell_velocity(cell, view(0.0)).along);
}

TEST(MotionState, RoundTripKeepsPlaceAndVelocity) {
  Component<double> c;
  c.position_m = {3.0, -4.0};
  c.velocity_mps = {1.0, 2.0};
  c.position_covariance = {0.5, 0.1, 0.4};
  c.velocity_covariance = {2.0, -0.3, 1.0};
  c.position_velocity_covariance = {0.1, 0.02, 0.03, 0.05};
  Component<double> back;
  set_kinematics(motion_state(c, 1.0), back);
  EXPECT_EQ(back.position_m.y, c.position_m.y);
  EXPECT_EQ(back.velocity_mps.x, c.velocity_mps.x);
  EXPECT_EQ(back.position_covariance.xy, c.position_covariance.xy);
  EXPECT_EQ(back.velocity_covariance.yy, c.velocity_covariance.yy);
  EXPECT_EQ(back.position_velocity_covariance.xy, c.position_velocity_covariance.xy);
  EXPECT_EQ(back.position_velocity_covariance.yx, c.position_velocity_covariance.yx);
}

}  // namespace
}  // namespace boresight::tracking::classical
