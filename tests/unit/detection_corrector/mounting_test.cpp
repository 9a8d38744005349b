// The part of the estimated rotation that may be applied.
#include "services/detection_corrector/core/mounting.hpp"

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::corrector {
namespace {

const Eigen::Vector3d kTurn = Eigen::Vector3d(1.5, -2.0, 1.0) * kRadiansPerDegree;

RadarConfig radar(double yaw_deg, double roll_deg = 0.0) {
  RadarConfig r;
  r.mounting_pose = {{3.6, 0.7, 0.5}, yaw_deg * kRadiansPerDegree, 0.0, roll_deg * kRadiansPerDegree};
  return r;
}

/// Both forms of kTurn; `covariance` about the vehicle's x, y, z.
AlignmentEstimate estimate(const RadarConfig& of, const Eigen::Matrix3d& covariance, std::uint32_t observable) {
  AlignmentEstimate e{};
  e.header.sequence = 5;
  e.observable = observable;
  e.speed_scale = 1.01F;
  e.vehicle_roll_rad = static_cast<float>(kTurn.x());
  e.vehicle_pitch_rad = static_cast<float>(-kTurn.y());
  e.vehicle_yaw_rad = static_cast<float>(kTurn.z());
  Eigen::Matrix3d to_message;  // (x, y, z) → (yaw, pitch, roll)
  to_message << 0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0;
  const Eigen::Matrix3f rows = (to_message * covariance * to_message.transpose()).cast<float>();
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      e.vehicle_covariance[static_cast<std::size_t>(4 * (r + 1) + c + 1)] = rows(r, c);
    }
  }
  const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(of.mounting_pose, 0.0, 0.0, 0.0);
  const Eigen::Vector3d angles =
      geometry::euler_angles(geometry::fixed_axes_rotation(kTurn.z(), -kTurn.y(), kTurn.x()) * nominal);
  e.alignment_yaw_rad = static_cast<float>(angles(0) - of.mounting_pose.yaw_rad);
  e.alignment_pitch_rad = static_cast<float>(angles(1));
  e.alignment_roll_rad = static_cast<float>(angles(2) - of.mounting_pose.roll_rad);
  return e;
}

constexpr std::uint32_t kAll =
    alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch | alignment_axis::kVehicleRoll;

Eigen::Matrix3d stds(double x_deg, double y_deg, double z_deg) {
  const Eigen::Vector3d std = Eigen::Vector3d(x_deg, y_deg, z_deg) * kRadiansPerDegree;
  return std.cwiseAbs2().asDiagonal();
}

/// The applied rotation about the vehicle's x, y, z.
Eigen::Vector3d applied(const RadarConfig& to, const AlignmentEstimate& e) {
  const Mounting mounting = mounting_of(to, &e, Config{});
  const Eigen::Vector3d angles = geometry::fixed_axes_angles(
      mounting.sensor_to_vehicle * geometry::sensor_to_vehicle(to.mounting_pose, 0.0, 0.0, 0.0).transpose());
  return {angles(2), -angles(1), angles(0)};
}

TEST(Mounting, ACertainEstimateIsAppliedAsAWhole) {
  for (const double yaw_deg : {0.0, 45.0, -135.0, 180.0}) {
    for (const double roll_deg : {0.0, 180.0}) {
      const RadarConfig r = radar(yaw_deg, roll_deg);
      const AlignmentEstimate e = estimate(r, stds(0.1, 0.1, 0.1), kAll);
      const Mounting mounting = mounting_of(r, &e, Config{});
      const Eigen::Matrix3d by_angles = geometry::sensor_to_vehicle(r.mounting_pose, e.alignment_yaw_rad,
                                                                    e.alignment_pitch_rad, e.alignment_roll_rad);
      EXPECT_LT((mounting.sensor_to_vehicle - by_angles).norm(), 1e-6) << yaw_deg << ", " << roll_deg;
      EXPECT_EQ(mounting.alignment_sequence, 5u);
    }
  }
}

TEST(Mounting, ACornerRadarIsCorrectedByTheKnownVehiclePitch) {
  // Straight driving: the rotation is certain about the vehicle's y and z, and not about x. About the sensor's own
  // axes, at 45°, neither pitch nor roll is known; an angle-by-angle decision would not apply the known pitch.
  const RadarConfig r = radar(45.0);
  const std::uint32_t observable = alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch;
  const Eigen::Vector3d turn = applied(r, estimate(r, stds(4.0, 0.1, 0.02), observable));
  EXPECT_LT((turn - Eigen::Vector3d(0.0, kTurn.y(), kTurn.z())).norm(), 1e-4 * kRadiansPerDegree);
  // The same with an observable axis that is not certain enough.
  const Eigen::Vector3d unsure = applied(r, estimate(r, stds(0.8, 0.1, 0.02), kAll));
  EXPECT_LT((unsure - Eigen::Vector3d(0.0, kTurn.y(), kTurn.z())).norm(), 1e-4 * kRadiansPerDegree);
}

TEST(Mounting, AnUnobservableAxisIsNotAppliedHoweverSmallItsVariance) {
  const RadarConfig r = radar(0.0);
  const Eigen::Vector3d turn = applied(r, estimate(r, stds(0.0, 0.0, 0.0), alignment_axis::kVehicleYaw));
  EXPECT_LT((turn - Eigen::Vector3d(0.0, 0.0, kTurn.z())).norm(), 1e-4 * kRadiansPerDegree);
  EXPECT_EQ(applied(r, estimate(r, stds(0.1, 0.1, 0.1), 0)).norm(), 0.0);
}

TEST(Mounting, APlateDeterminesTheSensorPitchOfACornerRadar) {
  // Pitch about the sensor's axis to 0.05°, roll about boresight to 2°: neither is certain about the vehicle's x and y.
  const RadarConfig r = radar(45.0);
  const Eigen::Vector3d boresight(std::sqrt(0.5), std::sqrt(0.5), 0.0), across(-std::sqrt(0.5), std::sqrt(0.5), 0.0);
  const Eigen::Matrix3d covariance = std::pow(2.0 * kRadiansPerDegree, 2) * boresight * boresight.transpose() +
                                     std::pow(0.05 * kRadiansPerDegree, 2) * across * across.transpose() +
                                     stds(0.0, 0.0, 0.05);
  const Eigen::Vector3d turn = applied(r, estimate(r, covariance, kAll));
  const Eigen::Vector3d expected = across * across.dot(kTurn) + Eigen::Vector3d(0.0, 0.0, kTurn.z());
  EXPECT_LT((turn - expected).norm(), 1e-3 * kRadiansPerDegree);
}

TEST(Mounting, WithoutAnEstimateItIsTheNominalMounting) {
  const RadarConfig r = radar(45.0);
  const Mounting mounting = mounting_of(r, nullptr, Config{});
  EXPECT_EQ(mounting.sensor_to_vehicle, geometry::sensor_to_vehicle(r.mounting_pose, 0.0, 0.0, 0.0));
  EXPECT_EQ(mounting.alignment_sequence, 0u);
  EXPECT_EQ(mounting.speed_scale, 1.0);
  EXPECT_NEAR(mounting.covariance(3, 3), std::pow(Config{}.unknown_rotation_std_rad, 2), 1e-12);
}

TEST(Mounting, AnEstimateFromWrongInputsIsNotApplied) {
  const RadarConfig to = radar(45.0);
  AlignmentEstimate e = estimate(to, stds(0.1, 0.1, 0.1), kAll);
  e.finding = AlignmentFinding::kRadarsSwapped;
  const Mounting nominal = mounting_of(to, nullptr, Config{}), mounting = mounting_of(to, &e, Config{});
  EXPECT_EQ(mounting.sensor_to_vehicle, nominal.sensor_to_vehicle);
  EXPECT_EQ(mounting.covariance, nominal.covariance);
  EXPECT_EQ(mounting.speed_scale, nominal.speed_scale);
  EXPECT_EQ(mounting.alignment_sequence, 0u);
}

TEST(Mounting, AnUnappliedEstimateWidensTheCovariance) {
  // About x it is uncertain: there the truth lies 1.5° ± 4° from the nominal mounting, about the other axes as
  // estimated.
  const RadarConfig r = radar(45.0);
  AlignmentEstimate e = estimate(r, stds(4.0, 0.1, 0.02), kAll);
  e.vehicle_covariance[0] = 4e-4F;
  e.observable |= alignment_axis::kSpeedScale;
  Config config;
  config.max_speed_scale_std_to_apply = 0.01;  // 0.02 is not certain enough: 1.01 is not applied
  const Mounting mounting = mounting_of(r, &e, config);
  EXPECT_NEAR(mounting.covariance(1, 1), (16.0 + 2.25) * kRadiansPerDegree * kRadiansPerDegree, 1e-6);
  EXPECT_NEAR(mounting.covariance(2, 2), 0.01 * kRadiansPerDegree * kRadiansPerDegree, 1e-7);
  EXPECT_NEAR(mounting.covariance(3, 3), 0.0004 * kRadiansPerDegree * kRadiansPerDegree, 1e-9);
  EXPECT_NEAR(mounting.covariance(0, 0), 4e-4 + 1e-4, 1e-7);
  EXPECT_EQ(mounting.speed_scale, 1.0);
}

}  // namespace
}  // namespace boresight::corrector
