#include "services/alignment_estimator/core/kpi/nees.hpp"

#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"

namespace boresight::alignment {
namespace {

TEST(Nees, IsOneOnAverageForConsistentErrorsAndCountsOnlyObservableAxes) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  Eigen::Matrix4d root = Eigen::Matrix4d::Zero();
  root.diagonal() << 1e-4, 3e-3, 1e-3, 2e-4;
  root(1, 0) = 2e-3;
  root(3, 2) = -1e-4;
  const Eigen::Matrix4d covariance = root * root.transpose();
  const Eigen::Matrix3d actual = geometry::sensor_to_vehicle(0.8, 0.02, -0.03);
  double all = 0.0, yaw = 0.0;
  constexpr int kRuns = 4000;
  for (int i = 0; i < kRuns; ++i) {
    const Eigen::Vector4d error =
        root * Eigen::Vector4d(normal(random), normal(random), normal(random), normal(random));
    RadarEstimate estimate;
    estimate.speed_scale = 1.01 - error(0);
    estimate.sensor_to_vehicle = geometry::so3_exp(-error.tail<3>()) * actual;
    estimate.covariance = covariance;
    estimate.observable = alignment_axis::kSpeedScale | alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch |
                          alignment_axis::kVehicleRoll;
    all += nees(estimate, 1.01, actual);
    estimate.observable = alignment_axis::kVehicleYaw;
    const double expected = error(3) * error(3) / covariance(3, 3);
    ASSERT_NEAR(nees(estimate, 1.01, actual), expected, 0.02 * expected + 1e-3);
    yaw += expected;
  }
  EXPECT_NEAR(all / kRuns, 1.0, 0.05);
  EXPECT_NEAR(yaw / kRuns, 1.0, 0.1);
}

TEST(Nees, WithoutCovarianceOrObservableAxesIsNotKnown) {
  RadarEstimate estimate;
  EXPECT_TRUE(std::isnan(nees(estimate, 1.0, Eigen::Matrix3d::Identity())));
  estimate.observable = alignment_axis::kVehicleYaw;
  EXPECT_TRUE(std::isnan(nees(estimate, 1.0, Eigen::Matrix3d::Identity()))) << "a covariance of 0";
}

}  // namespace
}  // namespace boresight::alignment
