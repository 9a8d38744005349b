// The motion model: closed forms, integration by numbers, composition of steps.
#include <cmath>

#include <gtest/gtest.h>

#include "services/tracker/core/filters/axis_motion.hpp"
#include "services/tracker/core/filters/constant_acceleration.hpp"
#include "tests/unit/tracker/filters_support.hpp"

namespace boresight::tracking::filters {
namespace {

ProcessNoise fading(double jerk_density_m2ps5, double decay_s) {
  ProcessNoise noise;
  noise.jerk_density_m2ps5 = jerk_density_m2ps5;
  noise.acceleration_decay_s = decay_s;
  return noise;
}

TEST(AxisMotion, OfLastingAccelerationHasTheTextbookForm) {
  const double t = 0.3, q = 0.7;
  const AxisMotion motion = axis_motion(t, testing::lasting_acceleration(q));
  Eigen::Matrix3d transition, covariance;
  transition << 1.0, t, t * t / 2.0, 0.0, 1.0, t, 0.0, 0.0, 1.0;
  covariance << std::pow(t, 5) / 20.0, std::pow(t, 4) / 8.0, std::pow(t, 3) / 6.0, std::pow(t, 4) / 8.0,
      std::pow(t, 3) / 3.0, t * t / 2.0, std::pow(t, 3) / 6.0, t * t / 2.0, t;
  EXPECT_LT((motion.transition - transition).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT((motion.covariance - q * covariance).cwiseAbs().maxCoeff(), 1e-15);
}

/// The response of [place, velocity, acceleration] to a unit of jerk that came a time ago, from the closed form.
Eigen::Vector3d response(double time_s, double decay_s) {
  const double x = time_s / decay_s;
  return {decay_s * decay_s * (std::expm1(-x) + x), -decay_s * std::expm1(-x), std::exp(-x)};
}

TEST(AxisMotion, OfFadingAccelerationIsTheIntegralOfItsResponse) {
  for (const double decay_s : {0.02, 0.3, 1.1, 2.0, 9.0}) {
    for (const double t : {0.05, 0.4, 1.0, 3.0}) {
      const AxisMotion motion = axis_motion(t, fading(2.0, decay_s));
      EXPECT_LT((motion.transition.col(2) - response(t, decay_s)).cwiseAbs().maxCoeff(), 1e-12 * (1.0 + t * t));
      // Simpson's rule.
      constexpr int kParts = 4000;
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      for (int i = 0; i <= kParts; ++i) {
        const Eigen::Vector3d r = response(t * i / kParts, decay_s);
        sum += (i == 0 || i == kParts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * r * r.transpose();
      }
      sum *= 2.0 * t / kParts / 3.0;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          EXPECT_NEAR(motion.covariance(i, j), sum(i, j), 1e-6 * sum(i, j)) << decay_s << " " << t << " " << i << j;
        }
      }
    }
  }
}

TEST(AxisMotion, IsContinuousWhereAccelerationLasts) {
  const AxisMotion lasting = axis_motion(0.2, testing::lasting_acceleration(1.0));
  const AxisMotion nearly = axis_motion(0.2, fading(1.0, 1e9));
  EXPECT_LT((lasting.transition - nearly.transition).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((lasting.covariance - nearly.covariance).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(AxisMotion, ComposesFromShorterSteps) {
  for (const double decay_s : {0.1, 0.7, 5.0, 1e12}) {
    const AxisMotion first = axis_motion(0.3, fading(1.5, decay_s)), second = axis_motion(0.5, fading(1.5, decay_s));
    const AxisMotion both = axis_motion(0.8, fading(1.5, decay_s));
    EXPECT_LT((both.transition - second.transition * first.transition).norm(), 1e-13) << decay_s;
    const Eigen::Matrix3d covariance =
        second.transition * first.covariance * second.transition.transpose() + second.covariance;
    EXPECT_LT((both.covariance - covariance).norm(), 1e-13) << decay_s;
  }
}

TEST(AxisMotion, StepBackUndoesTheStepForwardWithoutNoise) {
  for (const double decay_s : {0.2, 3.0, 1e12}) {
    const AxisMotion forward = axis_motion(0.35, fading(2.0, decay_s)), back = axis_motion(-0.35, fading(2.0, decay_s));
    EXPECT_LT((back.transition * forward.transition - Eigen::Matrix3d::Identity()).norm(), 1e-12) << decay_s;
    EXPECT_EQ(back.covariance.norm(), 0.0);
  }
}

TEST(AxisMotion, StopsToAccelerateWhenItCoastsForLong) {
  const AxisMotion motion = axis_motion(60.0, fading(0.1, 2.0));
  // An acceleration of a changes the velocity by a τ in all.
  EXPECT_NEAR(motion.transition(1, 2), 2.0, 1e-9);
  EXPECT_NEAR(motion.transition(2, 2), 0.0, 1e-9);
  // The variance of the acceleration is that of its stationary distribution, q τ / 2.
  EXPECT_NEAR(motion.covariance(2, 2), 0.1, 1e-9);
}

TEST(ConstantAcceleration, MovesEachAxisAlike) {
  const ConstantAcceleration<double, 3> motion(0.25, fading(1.0, 1.5));
  Vector<double, 9> state = Vector<double, 9>::LinSpaced(9, 1.0, 9.0);
  const Vector<double, 9> expected = motion.transition() * state;
  motion.move(state);
  EXPECT_LT((state - expected).norm(), 1e-13);
  const AxisMotion axis = axis_motion(0.25, fading(1.0, 1.5));
  for (int i = 0; i < 9; i += 3) {
    EXPECT_EQ((motion.transition().block<3, 3>(i, i) - axis.transition).norm(), 0.0);
    EXPECT_EQ((motion.noise().covariance.block<3, 3>(i, i) - axis.covariance).norm(), 0.0);
  }
  const Matrix<double, 9, 9> square = motion.noise().root * motion.noise().root.transpose();
  EXPECT_LT((square - motion.noise().covariance).norm(), 1e-15);
}

TEST(ConstantAcceleration, HasIndependentNoiseOfEachComponentIfAsked) {
  testing::Vector6 std;
  std << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6;
  const ConstantAcceleration<double, 2> motion(0.1, std);
  EXPECT_LT((motion.noise().covariance - testing::Matrix6(std.cwiseAbs2().asDiagonal())).norm(), 1e-16);
  EXPECT_EQ(motion.transition()(0, 1), 0.1);
}

TEST(ProcessNoise, IsValidIfFiniteAndNotNegative) {
  EXPECT_TRUE(fading(0.0, 1.0).is_valid());
  EXPECT_TRUE(testing::lasting_acceleration(1.0).is_valid());
  EXPECT_FALSE(fading(-1.0, 1.0).is_valid());
  EXPECT_FALSE(fading(std::nan(""), 1.0).is_valid());
  EXPECT_FALSE(fading(1.0, 0.0).is_valid());
  EXPECT_FALSE(fading(1.0, std::nan("")).is_valid());
}

}  // namespace
}  // namespace boresight::tracking::filters
