// Consequences of a mounting error against independent calculations.
#include "services/health/core/consequence.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::health {
namespace {

using geometry::sensor_to_vehicle;

constexpr double deg(double degrees) {
  return degrees * kRadiansPerDegree;
}

Sight corner_radar(double yaw_deg = 45.0) {
  Sight sight{};
  sight.mounting_pose.yaw_rad = deg(yaw_deg);
  sight.field_of_view = {.azimuth_min_rad = deg(-70.0),
                         .azimuth_max_rad = deg(70.0),
                         .elevation_min_rad = deg(-18.0),
                         .elevation_max_rad = deg(18.0)};
  sight.antenna = {.azimuth_width_rad = deg(140.0), .elevation_width_rad = deg(36.0)};
  return sight;
}

SightLoss loss(const Sight& sight, double yaw_deg, double pitch_deg = 0.0, double roll_deg = 0.0) {
  return sight_loss(sight, sensor_to_vehicle(sight.mounting_pose, deg(yaw_deg), deg(pitch_deg), deg(roll_deg)));
}

/// The lost share of the region by random directions on the sphere, with the bounds compared directly.
double lost_by_chance(const Sight& sight, const Eigen::Matrix3d& actual) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const Eigen::Matrix3d nominal = sensor_to_vehicle(sight.mounting_pose, 0.0, 0.0, 0.0);
  const auto sees = [&view = sight.field_of_view](const Eigen::Vector3d& in_sensor) {
    const double azimuth = std::atan2(in_sensor.y(), in_sensor.x()), elevation = std::asin(in_sensor.z());
    return azimuth >= view.azimuth_min_rad && azimuth <= view.azimuth_max_rad && elevation >= view.elevation_min_rad &&
           elevation <= view.elevation_max_rad;
  };
  int needed = 0, lost = 0;
  for (int i = 0; i < 2'000'000; ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    double azimuth = std::atan2(direction.y(), direction.x());
    if (azimuth < sight.region_of_interest.azimuth_min_rad) azimuth += 2.0 * std::numbers::pi;
    const double elevation = std::asin(direction.z());
    const RegionOfInterest& region = sight.region_of_interest;
    if (azimuth > region.azimuth_max_rad || elevation < region.elevation_min_rad ||
        elevation > region.elevation_max_rad || !sees(nominal.transpose() * direction)) {
      continue;
    }
    ++needed;
    if (!sees(actual.transpose() * direction)) ++lost;
  }
  return static_cast<double>(lost) / needed;
}

TEST(SightLoss, IsZeroWithoutAMountingError) {
  for (const double yaw_deg : {0.0, 45.0, 180.0, -135.0}) {
    const SightLoss none = loss(corner_radar(yaw_deg), 0.0);
    EXPECT_EQ(none.coverage_ratio, 0.0);
    EXPECT_NEAR(none.range_ratio, 0.0, 1e-12);
  }
}

TEST(SightLoss, YawLosesItsShareOfTheWidthAtOneEdge) {
  EXPECT_NEAR(loss(corner_radar(), 2.5).coverage_ratio, 2.5 / 140.0, 1e-8);
  EXPECT_NEAR(loss(corner_radar(), -2.5).coverage_ratio, 2.5 / 140.0, 1e-8);
}

TEST(SightLoss, AgreesWithRandomDirections) {
  Sight sight = corner_radar();
  sight.mounting_pose.pitch_rad = deg(5.0);
  sight.mounting_pose.roll_rad = deg(-10.0);
  for (const auto& [yaw_deg, pitch_deg, roll_deg] :
       {std::array{2.5, 0.0, 0.0}, std::array{0.0, -3.0, 0.0}, std::array{0.0, 0.0, 4.0}, std::array{-4.0, 2.0, 3.0}}) {
    const Eigen::Matrix3d actual = sensor_to_vehicle(sight.mounting_pose, deg(yaw_deg), deg(pitch_deg), deg(roll_deg));
    EXPECT_NEAR(sight_loss(sight, actual).coverage_ratio, lost_by_chance(sight, actual), 0.003)
        << yaw_deg << " " << pitch_deg << " " << roll_deg;
  }
}

TEST(SightLoss, CountsTheRegionOfInterestOnly) {
  Sight sight = corner_radar();
  // Nominal view: −25° … 115°. A turn to the right uncovers its left edge.
  sight.region_of_interest.azimuth_min_rad = deg(-25.0);
  sight.region_of_interest.azimuth_max_rad = deg(10.0);
  EXPECT_NEAR(loss(sight, -2.5).coverage_ratio, 0.0, 1e-9) << "the lost edge is not in the region";
  const Eigen::Matrix3d left = sensor_to_vehicle(sight.mounting_pose, deg(2.5), 0.0, 0.0);
  EXPECT_NEAR(sight_loss(sight, left).coverage_ratio, 2.5 / 35.0, 0.002);
  EXPECT_NEAR(sight_loss(sight, left).coverage_ratio, lost_by_chance(sight, left), 0.005);
  sight.region_of_interest.azimuth_min_rad = deg(-170.0);
  sight.region_of_interest.azimuth_max_rad = deg(-160.0);
  EXPECT_EQ(loss(sight, 10.0).coverage_ratio, 0.0) << "nothing of the region was ever seen";
}

TEST(SightLoss, RegionMayReachAcrossTheRear) {
  Sight sight = corner_radar(180.0);
  sight.region_of_interest.azimuth_min_rad = deg(150.0);
  sight.region_of_interest.azimuth_max_rad = deg(210.0);
  EXPECT_NEAR(loss(sight, 5.0).coverage_ratio, 0.0, 1e-9);
  const Eigen::Matrix3d actual = sensor_to_vehicle(sight.mounting_pose, 0.0, deg(6.0), 0.0);
  EXPECT_NEAR(sight_loss(sight, actual).coverage_ratio, lost_by_chance(sight, actual), 0.005);
}

TEST(SightLoss, DoesNotDependOnTheDirectionOfTheMounting) {
  const SightLoss ahead = loss(corner_radar(0.0), 2.0, -1.5, 4.0);
  for (const double yaw_deg : {45.0, 135.0, 180.0, -90.0}) {
    const SightLoss turned = loss(corner_radar(yaw_deg), 2.0, -1.5, 4.0);
    EXPECT_NEAR(turned.coverage_ratio, ahead.coverage_ratio, 1e-9) << yaw_deg;
    EXPECT_NEAR(turned.range_ratio, ahead.range_ratio, 1e-9) << yaw_deg;
  }
}

TEST(SightLoss, ViewAllAroundLosesNothingByYaw) {
  Sight sight = corner_radar();
  sight.field_of_view.azimuth_min_rad = deg(-180.0);
  sight.field_of_view.azimuth_max_rad = deg(180.0);
  EXPECT_NEAR(loss(sight, 30.0).coverage_ratio, 0.0, 1e-12);
}

TEST(SightLoss, RangeFollowsTheRadarEquation) {
  // Half of the azimuth width off boresight the power is a half one way and a quarter two ways: R falls by 4^(1/4).
  EXPECT_NEAR(loss(corner_radar(), 70.0).range_ratio, 1.0 - 1.0 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(loss(corner_radar(), 0.0, 18.0).range_ratio, 1.0 - 1.0 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(loss(corner_radar(), 0.0, -18.0).range_ratio, loss(corner_radar(), 0.0, 18.0).range_ratio, 1e-12);
  EXPECT_NEAR(loss(corner_radar(), 0.0, 0.0, 10.0).range_ratio, 0.0, 1e-9) << "a roll turns about boresight";
}

TEST(SightLoss, RangeGrowsInARegionThatComesNearerToBoresight) {
  Sight sight = corner_radar();
  sight.region_of_interest.azimuth_min_rad = deg(-25.0);
  sight.region_of_interest.azimuth_max_rad = deg(10.0);
  EXPECT_LT(loss(sight, -2.5).range_ratio, 0.0);
  EXPECT_GT(loss(sight, 2.5).range_ratio, 0.0);
}

TEST(Consequence, DisplacementAndVelocityErrorAgreeWithRotatedVectors) {
  EXPECT_NEAR(lateral_displacement_m(100.0, deg(2.5)), 4.3619387365336, 1e-9);
  for (const double yaw_deg : {-4.0, 0.0, 2.5}) {
    // A stationary object seems to move by the vehicle's velocity minus the same, turned.
    const Eigen::Vector3d velocity(30.0, 0.0, 0.0);
    const double seen = (velocity - sensor_to_vehicle(deg(yaw_deg), 0.0, 0.0) * velocity).norm();
    EXPECT_NEAR(velocity_error_mps(30.0, deg(yaw_deg)), seen, 1e-9);
    EXPECT_NEAR(velocity_error_mps(-30.0, deg(yaw_deg)), seen, 1e-9) << "reversing";
  }
}

TEST(ActualMounting, TakesTheFormWithMoreObservableAxes) {
  MountingPose pose;
  pose.yaw_rad = deg(45.0);
  AlignmentEstimate estimate{};
  estimate.alignment_yaw_rad = static_cast<float>(deg(2.0));
  estimate.alignment_pitch_rad = static_cast<float>(deg(9.0));  // of the prior
  estimate.vehicle_yaw_rad = static_cast<float>(deg(2.0));
  estimate.vehicle_pitch_rad = static_cast<float>(deg(1.0));
  estimate.observable = alignment_axis::kYaw;
  EXPECT_TRUE(actual_mounting(pose, estimate).isApprox(sensor_to_vehicle(pose, deg(2.0), 0.0, 0.0), 1e-6));
  estimate.observable |= alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch;
  const Eigen::Matrix3d by_vehicle =
      geometry::fixed_axes_rotation(deg(2.0), deg(1.0), 0.0) * sensor_to_vehicle(pose, 0.0, 0.0, 0.0);
  EXPECT_TRUE(actual_mounting(pose, estimate).isApprox(by_vehicle, 1e-6));
  estimate.observable = 0;
  EXPECT_TRUE(actual_mounting(pose, estimate).isApprox(sensor_to_vehicle(pose, 0.0, 0.0, 0.0), 1e-12));
}

}  // namespace
}  // namespace boresight::health
