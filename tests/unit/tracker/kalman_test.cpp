#include "services/tracker/core/kalman.hpp"

#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace boresight::tracking {
namespace {

KinematicState some_state() {
  KinematicState s;
  s.mean << 20.0, -4.0, 12.0, 3.0, 0.5, -0.8;
  const Matrix6d root = Matrix6d::Identity() + 0.2 * Matrix6d::Ones();
  s.covariance = root * root.transpose();
  return s;
}

PositionRate measure(const Vector6d& truth, const Eigen::Vector3d& noise = Eigen::Vector3d::Zero()) {
  PositionRate m;
  m.line_of_sight = truth.head<2>().normalized();
  m.value << truth.head<2>(), m.line_of_sight.dot(truth.segment<2>(2));
  m.value += noise;
  m.covariance = Eigen::Vector3d(0.25, 0.25, 0.04).asDiagonal();
  return m;
}

TEST(Kalman, PredictionIsTheIntegralOfTheMotion) {
  KinematicState s = some_state();
  const Vector6d before = s.mean;
  predict(s, 0.3, 1.0, geometry::EgoStep{});
  Vector6d expected = before;
  constexpr int kSteps = 300'000;
  const double dt = 0.3 / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector2d middle = expected.segment<2>(2) + 0.5 * dt * expected.tail<2>();
    expected.head<2>() += dt * middle;
    expected.segment<2>(2) += dt * expected.tail<2>();
  }
  EXPECT_LT((s.mean - expected).norm(), 1e-8);
}

TEST(Kalman, BrakesEndAtAStandstill) {
  // From 3 m/s at 6 m/s² in 0.5 s and 0.75 m, whatever the steps; the velocity across is noise.
  for (const int steps : {1, 7, 80}) {
    KinematicState s = some_state();
    s.mean << 20.0, -4.0, 3.0, 0.05, -6.0, 0.0;
    for (int i = 0; i < steps; ++i) predict(s, 1.0 / steps, 3.0, geometry::EgoStep{});
    EXPECT_NEAR(s.mean(0), 20.75, 0.02) << steps << " steps";
    EXPECT_NEAR(s.mean(1), -4.0, 0.05) << steps << " steps";
    EXPECT_EQ(s.mean.tail<4>().norm(), 0.0) << steps << " steps";
  }
  // What reverses already goes on to.
  KinematicState reversing = some_state();
  reversing.mean << 20.0, -4.0, -2.0, 0.0, -1.0, 0.0;
  predict(reversing, 0.5, 3.0, geometry::EgoStep{});
  EXPECT_NEAR(reversing.mean(2), -2.5, 1e-9);
}

TEST(Kalman, ProcessNoiseIsThatOfWhiteJerk) {
  // Two short steps are one long step: only the exact discretisation has that property.
  KinematicState once = some_state(), twice = some_state();
  predict(once, 0.4, 2.5, geometry::EgoStep{});
  predict(twice, 0.15, 2.5, geometry::EgoStep{});
  predict(twice, 0.25, 2.5, geometry::EgoStep{});
  EXPECT_LT((once.covariance - twice.covariance).norm(), 1e-10);
  EXPECT_LT((once.mean - twice.mean).norm(), 1e-12);
}

TEST(Kalman, AVehiclesAccelerationAcrossFadesAndTwoShortStepsAreOneLong) {
  KinematicState once = some_state(), twice = some_state();
  once.mean << 20.0, -4.0, 3.0, 0.0, 0.0, 0.8;
  twice.mean = once.mean;
  predict(once, 0.02, 3.0, geometry::EgoStep{}, Moves::kAsVehicle);
  predict(twice, 0.01, 3.0, geometry::EgoStep{}, Moves::kAsVehicle);
  predict(twice, 0.01, 3.0, geometry::EgoStep{}, Moves::kAsVehicle);
  EXPECT_LT((once.mean - twice.mean).norm(), 1e-4) << "but for the course, which turns";
  EXPECT_LT((once.covariance - twice.covariance).norm(), 1e-2);
  EXPECT_NEAR(once.mean(5), 0.8 * std::exp(-0.02), 1e-9);
  EXPECT_NEAR(once.mean(3), 0.8 * (1.0 - std::exp(-0.02)), 1e-9);
  EXPECT_NEAR(once.mean(1), -4.0 + 0.8 * (0.02 - (1.0 - std::exp(-0.02))), 1e-9);
}

TEST(Kalman, AcrossItsCourseAVehicleAcceleratesNoMoreThanATurnDoes) {
  // On a circle of 10 m at 3 m/s: 0.9 m/s². Along it nothing bounds the acceleration, nor that of people at all.
  for (const Moves moves : {Moves::kAsVehicle, Moves::kAnyWay}) {
    KinematicState s = some_state();
    for (int i = 0; i < 400; ++i) {
      s.mean << 20.0, -4.0, 3.0, 0.0, 0.0, 0.0;
      predict(s, 0.02, 3.0, geometry::EgoStep{}, moves);
    }
    const double along = std::sqrt(s.covariance(4, 4)), across = std::sqrt(s.covariance(5, 5));
    EXPECT_GT(along, 8.0);
    EXPECT_NEAR(across, moves == Moves::kAsVehicle ? 0.9 : along, 0.1);
  }
}

TEST(Kalman, AVehicleGoingAnyOtherWayIsPredictedAlike) {
  const Eigen::Rotation2Dd turn(0.7);
  Matrix6d turned = Matrix6d::Zero();
  for (Eigen::Index k = 0; k < 6; k += 2) turned.block<2, 2>(k, k) = turn.toRotationMatrix();
  KinematicState s = some_state(), other = some_state();
  other.mean = turned * s.mean;
  other.covariance = turned * s.covariance * turned.transpose();
  predict(s, 0.1, 3.0, geometry::EgoStep{}, Moves::kAsVehicle);
  predict(other, 0.1, 3.0, geometry::EgoStep{}, Moves::kAsVehicle);
  EXPECT_LT((other.mean - turned * s.mean).norm(), 1e-9);
  EXPECT_LT((other.covariance - turned * s.covariance * turned.transpose()).norm(), 1e-9);
}

TEST(Kalman, BrakesEndAtAStandstillWhateverNoiseSeemsToGoAside) {
  KinematicState state;
  state.mean << 4.0, 3.6, 2.0, -0.4, -9.0, 0.0;
  state.heading.known = true;
  state.heading.rad = 0.0;
  for (int i = 0; i < 80; ++i) predict(state, 0.0125, 3.0, {}, Moves::kAsVehicle);
  EXPECT_NEAR(state.mean(0), 4.0 + 2.0 * 2.0 / (2.0 * 9.0), 0.02);
  EXPECT_EQ(state.mean(2), 0.0);
  EXPECT_EQ(state.mean(3), 0.0);
}

TEST(Kalman, WhatStandsStillInTheWorldStaysThereAsTheVehicleMoves) {
  const double speed = 14.0, yaw_rate = 0.4;
  Eigen::Vector2d world(30.0, 8.0), place(0.0, 0.0);
  double heading = 0.0;
  KinematicState s;
  s.mean.head<2>() = world;
  for (int i = 0; i < 100; ++i) {
    const geometry::EgoStep step = geometry::ego_step(speed, yaw_rate, 0.05);
    predict(s, 0.05, 0.0, step);
    place += Eigen::Rotation2Dd(heading) * step.translation_m;
    heading += yaw_rate * 0.05;
    EXPECT_LT((s.mean.head<2>() - Eigen::Rotation2Dd(-heading) * (world - place)).norm(), 1e-9);
  }
  EXPECT_LT(s.mean.tail<4>().norm(), 1e-12);
}

TEST(Kalman, AnErrorOfTheOwnTurnMovesAsideWhatIsFarAway) {
  KinematicState s = some_state();
  const Matrix6d before = s.covariance;
  blur_own_turn(s, 1e-4);
  const Eigen::Vector2d sight = s.mean.head<2>().normalized(), across(-sight.y(), sight.x());
  const Eigen::Matrix2d more = (s.covariance - before).topLeftCorner<2, 2>();
  EXPECT_NEAR(across.dot(more * across), 1e-4 * s.mean.head<2>().squaredNorm(), 1e-9);
  EXPECT_NEAR(sight.dot(more * sight), 0.0, 1e-9);
}

TEST(Kalman, VelocityTurnsWithTheAxesOfTheVehicle) {
  KinematicState s = some_state();
  s.mean.tail<2>().setZero();
  const Eigen::Vector2d before = s.mean.segment<2>(2);
  predict(s, 0.1, 0.0, geometry::ego_step(0.0, 1.0, 0.1));
  EXPECT_LT((s.mean.segment<2>(2) - Eigen::Rotation2Dd(-0.1) * before).norm(), 1e-12);
  EXPECT_NEAR(
      s.covariance.trace(),
      [] {
        KinematicState t = some_state();
        predict(t, 0.1, 0.0, geometry::EgoStep{});
        return t.covariance.trace();
      }(),
      1e-9)
      << "a rotation keeps the trace";
}

TEST(Kalman, UpdateIsTheTextbooksAndTheInformationFilters) {
  KinematicState s = some_state();
  Vector6d truth = s.mean;
  truth.head<2>() += Eigen::Vector2d(0.4, -0.3);
  const PositionRate m = measure(truth);
  Eigen::Matrix<double, 3, 6> h = Eigen::Matrix<double, 3, 6>::Zero();
  h(0, 0) = h(1, 1) = 1.0;
  h.block<1, 2>(2, 2) = m.line_of_sight.transpose();
  // The same by adding information, which shares no formula with the gain.
  const Matrix6d information = s.covariance.inverse() + h.transpose() * m.covariance.inverse() * h;
  const Vector6d mean =
      information.inverse() * (s.covariance.inverse() * s.mean + h.transpose() * m.covariance.inverse() * m.value);
  ASSERT_TRUE(update(s, m));
  EXPECT_LT((s.mean - mean).norm(), 1e-9);
  EXPECT_LT((s.covariance - information.inverse()).norm(), 1e-9);
}

TEST(Kalman, ARangeRateAloneIsAMeasurementWhosePlaceSaysNothing) {
  KinematicState s = some_state(), other = some_state();
  for (KinematicState* state : {&s, &other}) {
    state->heading.known = true;
    state->heading.rad = 0.2;
    state->heading.variance = 0.09;
    state->heading.with_rest << 0.0, 0.0, 0.05, 0.1, 0.0, 0.0;
  }
  PositionRate m = measure(s.mean);
  m.value(2) += 0.7;
  m.covariance = Eigen::Vector3d(1e9, 1e9, 0.04).asDiagonal();
  ASSERT_TRUE(update(s, m));
  update_rate(other, m.line_of_sight, m.value(2), 0.04);
  EXPECT_LT((s.mean - other.mean).norm(), 1e-6);
  EXPECT_LT((s.covariance - other.covariance).norm(), 1e-5);
  EXPECT_NEAR(s.heading.rad, other.heading.rad, 1e-7);
  EXPECT_NEAR(s.heading.variance, other.heading.variance, 1e-7);
  EXPECT_LT((s.heading.with_rest - other.heading.with_rest).norm(), 1e-6);
}

TEST(Kalman, DistanceIsTheMahalanobisDistance) {
  KinematicState s = some_state();
  PositionRate m = measure(s.mean);
  EXPECT_NEAR(distance(s, m).squared, 0.0, 1e-12);
  m.value(0) += 1.0;
  KinematicState moved = s;
  moved.mean(0) += 1.0;
  EXPECT_NEAR(distance(s, m).squared, distance(moved, measure(s.mean)).squared, 0.2);
  EXPECT_GT(distance(s, m).squared, 0.0);
}

TEST(Kalman, CovarianceStaysSymmetricAndPositive) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> step(0.0, 0.3), turn(-0.5, 0.5);
  KinematicState s = some_state();
  for (int i = 0; i < 10'000; ++i) {
    const double dt = step(random);
    predict(s, dt, 3.0, geometry::ego_step(15.0, turn(random), dt));
    Vector6d about = s.mean;
    about.head<2>() += 0.5 * Eigen::Vector2d(normal(random), normal(random));
    ASSERT_TRUE(update(s, measure(about)));
    ASSERT_TRUE(s.mean.allFinite());
    ASSERT_LT((s.covariance - s.covariance.transpose()).norm(), 1e-9);
    ASSERT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(s.covariance).eigenvalues().minCoeff(), 0.0) << i;
  }
}

TEST(Kalman, ASingularInnovationIsRefused) {
  KinematicState s = some_state();
  s.covariance.setZero();
  const KinematicState before = s;
  PositionRate m = measure(s.mean);
  m.covariance.setZero();
  EXPECT_FALSE(update(s, m));
  EXPECT_EQ(s.mean, before.mean);
  EXPECT_GT(distance(s, m).squared, 1e9) << "never within a gate";
}

TEST(Kalman, IsConsistentWithItsOwnModel) {
  // Monte Carlo with jerk and noise as the filter assumes them: the normalised errors follow χ².
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.0, 1.0);
  constexpr double kJerk = 2.0, kStep_s = 0.05;
  constexpr int kRuns = 200, kSteps = 60;
  double nees = 0.0, nis = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Vector6d truth;
    truth << 30.0, 5.0, -8.0, 1.0, 0.0, 0.0;
    KinematicState s;
    s.covariance = Eigen::DiagonalMatrix<double, 6>(1.0, 1.0, 4.0, 4.0, 1.0, 1.0);
    for (Eigen::Index k = 0; k < 6; ++k) s.mean(k) = truth(k) + std::sqrt(s.covariance(k, k)) * normal(random);
    for (int i = 0; i < kSteps; ++i) {
      // The truth takes many small steps of constant jerk.
      constexpr int kParts = 20;
      const double dt = kStep_s / kParts;
      for (int part = 0; part < kParts; ++part) {
        const Eigen::Vector2d jerk = kJerk / std::sqrt(dt) * Eigen::Vector2d(normal(random), normal(random));
        truth.head<2>() += dt * truth.segment<2>(2) + 0.5 * dt * dt * truth.tail<2>();
        truth.segment<2>(2) += dt * truth.tail<2>();
        truth.tail<2>() += dt * jerk;
      }
      predict(s, kStep_s, kJerk, geometry::EgoStep{});
      const PositionRate m = measure(truth, {0.5 * normal(random), 0.5 * normal(random), 0.2 * normal(random)});
      nis += distance(s, m).squared;
      ASSERT_TRUE(update(s, m));
    }
    nees += (truth - s.mean).dot(s.covariance.inverse() * (truth - s.mean));
  }
  // 99.9 % bounds of the means of 200 × 6 and 12,000 × 3 degrees of freedom (approximately normal).
  EXPECT_NEAR(nees / kRuns, 6.0, 3.3 * std::sqrt(2.0 * 6.0 / kRuns));
  EXPECT_NEAR(nis / (kRuns * kSteps), 3.0, 3.3 * std::sqrt(2.0 * 3.0 / (kRuns * kSteps)) + 0.05);
}

}  // namespace
}  // namespace boresight::tracking
