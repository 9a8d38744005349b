// Filters that must agree: all on linear measurements, all unscented forms on any, all under a rotation of the axes.
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "services/tracker/core/filters/motion_filter.hpp"
#include "tests/unit/tracker/filters_support.hpp"

namespace boresight::tracking::filters {
namespace {

using testing::Matrix6;
using testing::Vector6;

Gaussian<double, 6> correlated_start() {
  Gaussian<double, 6> start;
  start.mean << 30.0, -8.0, 0.5, 6.0, 3.0, -0.2;
  Matrix6 mixed;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) mixed(i, j) = std::cos(1.0 + 3.0 * i + 1.7 * j);
  }
  start.covariance = mixed * mixed.transpose() + 0.5 * Matrix6::Identity();
  return start;
}

Noise<double, 3> correlated_noise(double scale) {
  Matrix<double, 3, 3> covariance;
  covariance << 0.2, 0.01, 0.02, 0.01, 4e-3, 1e-3, 0.02, 1e-3, 0.05;
  return *noise_of<double, 3>(Matrix<double, 3, 3>(scale * covariance));
}

void expect_equal(const Gaussian<double, 6>& a, const Gaussian<double, 6>& b, double tolerance, const char* what) {
  EXPECT_LT((a.mean - b.mean).cwiseAbs().maxCoeff(), tolerance) << what;
  EXPECT_LT((a.covariance - b.covariance).cwiseAbs().maxCoeff(), tolerance) << what;
}

/// Some steps of a filter with one measurement model.
template <typename Filter, typename Measurement, int M>
Gaussian<double, 6> after_steps(Filter filter, const Measurement& measurement, const Noise<double, M>& noise) {
  ProcessNoise jerk;
  jerk.jerk_density_m2ps5 = 0.6;
  jerk.acceleration_decay_s = 2.5;
  Gaussian<double, 6> last = filter.gaussian();
  for (int k = 0; k < 30; ++k) {
    // Steps of any length; every fifth goes back.
    const ConstantAcceleration<double, 2> motion(k % 5 == 4 ? -0.04 : 0.03 + 0.02 * (k % 3), jerk);
    EXPECT_TRUE(filter.predict(motion)) << k;
    Vector<double, M> value = measurement.expected(filter.gaussian().mean);
    for (int i = 0; i < M; ++i) value(i) += std::sin(2.0 * k + i) * noise.root(i, i);
    EXPECT_TRUE(filter.update(measurement, value, noise)) << k;
    last = filter.gaussian();
  }
  return last;
}

TEST(Filters, AgreeOnLinearMeasurements) {
  const auto measurement = position_and_range_rate_measurement<double>({std::cos(0.3), std::sin(0.3)});
  const Noise<double, 3> noise = correlated_noise(1.0);
  const Gaussian<double, 6> start = correlated_start();
  const Gaussian<double, 6> exact = after_steps(Kalman<double, 6>(start), measurement, noise);
  constexpr double kRounding = 1e-11;
  expect_equal(after_steps(ExtendedKalman<double, 6>(start), measurement, noise), exact, kRounding, "ekf");
  expect_equal(after_steps(Unscented<double, 6>(start), measurement, noise), exact, kRounding, "ukf");
  expect_equal(after_steps(SquareRootUnscented<double, 6>(start), measurement, noise), exact, kRounding, "srukf");
  expect_equal(after_steps(testing::Published<double>(start), measurement, noise), exact, kRounding, "published");
  expect_equal(after_steps(testing::CovarianceForm<double>(start), measurement, noise), exact, kRounding, "covariance");
  expect_equal(after_steps(testing::PureRoot<double>(start), measurement, noise), exact, kRounding, "pure root");
}

TEST(Filters, AgreeOnLinearMeasurementsWithAnySigmaPoints) {
  const auto measurement = position_measurement<double>();
  const Noise<double, 2> noise = independent_noise<double, 2>(Eigen::Vector2d(0.4, 0.7));
  const Gaussian<double, 6> start = correlated_start();
  const Gaussian<double, 6> exact = after_steps(Kalman<double, 6>(start), measurement, noise);
  for (const SigmaPointParameters& parameters :
       {SigmaPointParameters{0.1, 2.0, 0.0}, SigmaPointParameters{1.0, 0.0, -3.0},
        SigmaPointParameters{0.7, 2.0, 3.0}}) {
    expect_equal(after_steps(Unscented<double, 6>(start, parameters), measurement, noise), exact, 1e-9, "ukf");
    expect_equal(after_steps(SquareRootUnscented<double, 6>(start, parameters), measurement, noise), exact, 1e-9,
                 "srukf");
  }
}

TEST(Filters, UnscentedFormsAgreeForAMovedAndRotatedSensor) {
  const Gaussian<double, 6> start = correlated_start();
  const Noise<double, 3> noise = correlated_noise(0.3);
  for (const double yaw_rad : {0.0, 2.2, -3.0}) {
    // Beside the object, and beyond it, so that azimuths cross ±π.
    for (const Vector<double, 2>& place : {Vector<double, 2>(3.4, 0.9), Vector<double, 2>(60.0, 9.0)}) {
      const PolarMeasurement<double> sensor{place, yaw_rad};
      for (const SigmaPointParameters& parameters : {SigmaPointParameters{}, SigmaPointParameters{0.5, 2.0, 1.0}}) {
        const Gaussian<double, 6> full = after_steps(SquareRootUnscented<double, 6>(start, parameters), sensor, noise);
        constexpr double kRounding = 1e-9;
        expect_equal(after_steps(Unscented<double, 6>(start, parameters), sensor, noise), full, kRounding, "ukf");
        expect_equal(after_steps(testing::Published<double>(start, parameters), sensor, noise), full, kRounding,
                     "published");
        expect_equal(after_steps(testing::CovarianceForm<double>(start, parameters), sensor, noise), full, kRounding,
                     "covariance");
        expect_equal(after_steps(testing::PureRoot<double>(start, parameters), sensor, noise), full, kRounding,
                     "pure root");
      }
    }
  }
}

TEST(Filters, UnscentedFormsAgreeWithoutRangeRate) {
  const Gaussian<double, 6> start = correlated_start();
  const Noise<double, 2> noise = independent_noise<double, 2>(Eigen::Vector2d(0.5, 0.05));
  const PolarMeasurement<double, 2> sensor{{-1.0, 2.0}, 0.7};
  const Gaussian<double, 6> full = after_steps(SquareRootUnscented<double, 6>(start), sensor, noise);
  expect_equal(after_steps(Unscented<double, 6>(start), sensor, noise), full, 1e-9, "ukf");
  expect_equal(after_steps(testing::CovarianceForm<double>(start), sensor, noise), full, 1e-9, "covariance");
  expect_equal(after_steps(testing::PureRoot<double>(start), sensor, noise), full, 1e-9, "pure root");
}

/// Both axes of the state turned.
Matrix6 rotation6(double angle_rad) {
  Matrix6 rotation = Matrix6::Zero();
  for (int i = 0; i < 3; ++i) {
    rotation(i, i) = rotation(3 + i, 3 + i) = std::cos(angle_rad);
    rotation(i, 3 + i) = -std::sin(angle_rad);
    rotation(3 + i, i) = std::sin(angle_rad);
  }
  return rotation;
}

/// The same scene in axes that are turned by an angle.
MotionState in_turned_axes(FilterKind kind, double angle_rad) {
  const Matrix6 turn6 = rotation6(angle_rad);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
  const Gaussian<double, 6> start = correlated_start();
  MotionFilter filter(kind, {turn6 * start.mean, turn6 * start.covariance * turn6.transpose()});
  ProcessNoise noise;
  noise.acceleration_decay_s = 3.0;
  Eigen::Matrix2d covariance;
  covariance << 0.3, 0.1, 0.1, 0.2;
  const Eigen::Vector2d sensor(2.0, -1.0);
  for (int k = 0; k < 25; ++k) {
    EXPECT_TRUE(filter.predict(0.06, noise));
    const Eigen::Vector2d place(30.0 - 0.48 * k + 0.3 * std::sin(k), 6.0 + 0.18 * k + 0.3 * std::cos(2.0 * k));
    const Eigen::Vector2d line = (place - sensor).normalized();
    const RangeRate range_rate{turn * line, line.dot(Eigen::Vector2d(-8.0, 3.0)) + 0.1 * std::sin(3.0 * k), 0.02};
    EXPECT_TRUE(filter.update(turn * place, turn * covariance * turn.transpose(), range_rate, turn * sensor));
    if (k % 7 == 3) {
      EXPECT_TRUE(filter.shift(turn * Eigen::Vector2d(0.4, 0.1)));
      EXPECT_TRUE(filter.shift(turn * Eigen::Vector2d(-0.4, -0.1)));
      EXPECT_TRUE(filter.update_velocity(turn * Eigen::Vector2d(-8.0, 3.0), 4.0 * Eigen::Matrix2d::Identity()));
    }
  }
  const MotionState state = filter.state();
  return {turn6.transpose() * state.mean, turn6.transpose() * state.covariance * turn6};
}

TEST(MotionFilter, DoesNotDependOnTheDirectionOfTheAxes) {
  for (const std::string_view name : filter_kind_names()) {
    const FilterKind kind = *filter_kind(name);
    const MotionState straight = in_turned_axes(kind, 0.0);
    for (const double angle_rad : {0.5, 1.5707963, 2.9, -2.0}) {
      const MotionState turned = in_turned_axes(kind, angle_rad);
      // The directions of sigma points depend on the axes, so the unscented kinds are equal to higher order only.
      const bool has_sigma_points = kind != FilterKind::kKalman && kind != FilterKind::kExtendedKalman;
      const double tolerance = has_sigma_points ? 0.03 : 1e-8;
      for (int i = 0; i < 6; ++i) {
        const double std = std::sqrt(straight.covariance(i, i));
        EXPECT_NEAR(turned.mean(i), straight.mean(i), tolerance * std) << name << " " << angle_rad << " " << i;
        EXPECT_NEAR(std::sqrt(turned.covariance(i, i)), std, tolerance * std) << name << " " << angle_rad << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace boresight::tracking::filters
