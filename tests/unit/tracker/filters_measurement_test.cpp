// Measurement models: derivatives by numbers, a moved and rotated sensor, angles across the seam.
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/unit/tracker/filters_support.hpp"

namespace boresight::tracking::filters {
namespace {

using testing::Vector6;

TEST(PolarMeasurement, HasTheDerivativesOfItsValue) {
  PolarMeasurement<double> sensor{{3.7, -0.8}, 0.4};
  for (int i = 0; i < 12; ++i) {
    Vector6 state;
    const double angle = 0.55 * i;
    state << 3.7 + 20.0 * std::cos(angle), 3.0 - i, 0.5, -0.8 + 20.0 * std::sin(angle), 0.7 * i, -0.2;
    const Matrix<double, 3, 6> jacobian = sensor.jacobian(state);
    for (int j = 0; j < 6; ++j) {
      constexpr double kStep = 1e-5;
      Vector6 forward = state, back = state;
      forward(j) += kStep;
      back(j) -= kStep;
      const Vector<double, 3> slope =
          PolarMeasurement<double>::difference(sensor.expected(forward), sensor.expected(back)) / (2.0 * kStep);
      EXPECT_LT((jacobian.col(j) - slope).cwiseAbs().maxCoeff(), 1e-8) << i << " " << j;
    }
    const PolarMeasurement<double, 2> without_range_rate{sensor.sensor_m, 0.4};
    EXPECT_LT((without_range_rate.jacobian(state) - jacobian.topRows<2>()).norm(), 1e-15);
    EXPECT_LT((without_range_rate.expected(state) - sensor.expected(state).head<2>()).norm(), 1e-15);
  }
}

TEST(PolarMeasurement, OfARotatedAndMovedSensorHasNoInnovationWhereItAgrees) {
  // A radar at the rear right corner that looks backwards; the object is behind it.
  const double yaw_rad = -2.4;
  const PolarMeasurement<double> sensor{{-0.9, -0.7}, yaw_rad};
  Vector6 state;
  state << -14.0, 2.0, 0.0, -9.0, -3.0, 0.0;
  const Eigen::Vector2d line = Eigen::Vector2d(-14.0 + 0.9, -9.0 + 0.7);
  const Eigen::Vector2d in_sensor = Eigen::Rotation2Dd(-yaw_rad) * line;
  const Vector<double, 3> measured(line.norm(), std::atan2(in_sensor.y(), in_sensor.x()),
                                   line.normalized().dot(Eigen::Vector2d(2.0, -3.0)));
  EXPECT_LT(sensor.innovation(measured, sensor.expected(state)).norm(), 1e-12);
  // Without the yaw the azimuth would be off by it.
  const PolarMeasurement<double> not_rotated{sensor.sensor_m, 0.0};
  EXPECT_NEAR(std::abs(not_rotated.innovation(measured, sensor.expected(state))(1)), 2.4, 1e-12);
}

TEST(PolarMeasurement, WrapsAzimuths) {
  const PolarMeasurement<double> sensor;
  Vector6 above, below;
  above << -10.0, 0.0, 0.0, 0.1, 0.0, 0.0;
  below << -10.0, 0.0, 0.0, -0.1, 0.0, 0.0;
  const Vector<double, 3> difference =
      PolarMeasurement<double>::difference(sensor.expected(above), sensor.expected(below));
  EXPECT_NEAR(difference(1), -2.0 * std::atan(0.01), 1e-12);
  // A measured azimuth may be of any turn.
  Vector<double, 3> measured = sensor.expected(above);
  measured(1) += 6.0 * M_PI;
  EXPECT_NEAR(sensor.innovation(measured, sensor.expected(below))(1), -2.0 * std::atan(0.01), 1e-12);
}

TEST(LinearMeasurement, SeesPlaceRangeRateAndVelocity) {
  Vector6 state;
  state << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  EXPECT_EQ(position_measurement<double>().expected(state), Eigen::Vector2d(1.0, 4.0));
  EXPECT_EQ(velocity_measurement<double>().expected(state), Eigen::Vector2d(2.0, 5.0));
  const auto measurement = position_and_range_rate_measurement<double>({0.6, 0.8});
  EXPECT_EQ(measurement.expected(state), Eigen::Vector3d(1.0, 4.0, 0.6 * 2.0 + 0.8 * 5.0));
}

}  // namespace
}  // namespace boresight::tracking::filters
