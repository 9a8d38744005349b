// What an estimate says beyond mounting and k_v: the radar's own scale of range rates, load, curve of azimuth errors,
// yaw-rate gain and time offset.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/detection_corrector/core/corrector.hpp"
#include "services/detection_corrector/core/ego_velocity.hpp"

namespace boresight::corrector {
namespace {

constexpr std::int64_t kMeasured_ns = 2'000'000'000'000;
constexpr double kSignalled_mps = 25.0, kTrueScale = 1.012, kYawRate_radps = 0.1;

VehicleConfig corner_radars() {
  VehicleConfig vehicle;
  for (std::uint32_t id = 1; id <= 2; ++id) {
    RadarConfig radar;
    radar.id = id;
    radar.mounting_pose = {{3.6, id == 1 ? 0.7 : -0.7, 0.5}, (id == 1 ? 45.0 : -45.0) * kRadiansPerDegree, 0.0, 0.0};
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

/// A converged estimate without mounting error; k_v as a radar with the scale 1 + `e` sees it.
AlignmentEstimate converged(std::uint32_t radar, double e) {
  AlignmentEstimate estimate{};
  estimate.header.source_id = radar;
  estimate.header.sequence = 9;
  estimate.header.measurement_time_ns = kMeasured_ns;
  estimate.state = AlignmentState::kConverged;
  estimate.observable = alignment_axis::kSpeedScale | alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch |
                        alignment_axis::kVehicleRoll;
  estimate.speed_scale = static_cast<float>(kTrueScale * (1.0 + e));
  estimate.vehicle_covariance[0] = 1e-9F;
  for (const std::size_t i : {5U, 10U, 15U}) estimate.vehicle_covariance[i] = 1e-7F;
  estimate.nuisance.range_rate_scale = {static_cast<float>(e), 0.002F};
  return estimate;
}

class RealCar : public testing::Test {
 protected:
  RealCar() {
    EgoMotion ego{};
    ego.header.measurement_time_ns = kMeasured_ns;
    ego.fields = ego_field::kSpeed | ego_field::kYawRate;
    ego.speed_mps = static_cast<float>(kSignalled_mps);
    ego.speed_std_mps = 0.01F;
    ego.yaw_rate_radps = static_cast<float>(kYawRate_radps);
    ego.yaw_rate_std_radps = 0.001F;
    corrector_.add_ego_motion(ego);
    scan_->header = {};
    scan_->header.measurement_time_ns = kMeasured_ns;
    scan_->fields = scan_field::kElevation;
    scan_->number_of_valid_detections = 1;
    scan_->detection_flags[0] = 0;
  }
  const RadarConfig& radar(std::uint32_t id) const { return *vehicle_.radar(id); }
  Eigen::Vector3d velocity_of(std::uint32_t id) const {
    return geometry::sensor_velocity(kTrueScale, kSignalled_mps, kYawRate_radps, radar(id).mounting_pose.position_m);
  }
  /// Corrects a detection.
  const CorrectedScan& correct(std::uint32_t id, double azimuth_rad, double elevation_rad, double range_rate_mps) {
    scan_->header.source_id = id;
    scan_->range_m[0] = 40.0F;
    scan_->azimuth_rad[0] = static_cast<float>(azimuth_rad);
    scan_->elevation_rad[0] = static_cast<float>(elevation_rad);
    scan_->range_rate_mps[0] = static_cast<float>(range_rate_mps);
    corrector_.correct(*scan_, *out_);
    return *out_;
  }
  VehicleConfig vehicle_ = corner_radars();
  Corrector corrector_{vehicle_, Config{}};
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  std::unique_ptr<CorrectedScan> out_ = std::make_unique<CorrectedScan>();
};

TEST_F(RealCar, RadarsWithDifferentRangeRateScalesAgree) {
  // An object ahead drives at 15 m/s over ground; one radar measures range rates 0.25 % too large, one 0.25 % too
  // small.
  for (const auto& [id, e] : {std::pair{1U, 0.0025}, std::pair{2U, -0.0025}}) {
    ASSERT_TRUE(corrector_.add_alignment(converged(id, e)));
    const double azimuth = id == 1 ? -0.8 : 0.8;
    const Eigen::Vector3d line =
        geometry::sensor_to_vehicle(radar(id).mounting_pose, 0.0, 0.0, 0.0) * geometry::direction(azimuth, 0.0);
    const double over_ground = line.dot(Eigen::Vector3d(15.0, 0.0, 0.0));
    const double range_rate = over_ground - line.dot(velocity_of(id));
    const CorrectedScan& out = correct(id, azimuth, 0.0, (1.0 + e) * range_rate);
    EXPECT_NEAR(out.range_rate_mps[0], range_rate, 1e-4) << id;
    EXPECT_NEAR(out.range_rate_over_ground_mps[0], over_ground, 1e-4) << id;
    EXPECT_NEAR(out.geometry.speed_scale, kTrueScale, 1e-6) << id;
    EXPECT_NEAR(out.geometry.ego_speed_mps, kTrueScale * kSignalled_mps, 1e-4) << id;
    EXPECT_NE(out.detection_flags[0] & corrected_flag::kMoving, 0) << id;
  }
}

TEST_F(RealCar, AStationaryReflectorOfAScaledRadarIsStationaryAndHasNoRangeRateOverGround) {
  ASSERT_TRUE(corrector_.add_alignment(converged(1, 0.0025)));
  const Eigen::Vector3d line =
      geometry::sensor_to_vehicle(radar(1).mounting_pose, 0.0, 0.0, 0.0) * geometry::direction(-0.8, 0.0);
  const CorrectedScan& out = correct(1, -0.8, 0.0, -1.0025 * line.dot(velocity_of(1)));
  EXPECT_NEAR(out.range_rate_over_ground_mps[0], 0.0, 1e-4);
  EXPECT_NE(out.detection_flags[0] & corrected_flag::kStationary, 0);
}

TEST_F(RealCar, AnUnknownRangeRateScaleWidensTheThresholdByTheLeverArmOnly) {
  // σ of e = 0.2 % would be 0.05 m/s at 25 m/s, as much as all other terms; (1 + e)·k_v is known to 3e-5.
  AlignmentEstimate estimate = converged(1, 0.0025);
  const EgoSample sample{.valid = true,
                         .speed_mps = kSignalled_mps,
                         .speed_std_mps = 0.01,
                         .yaw_rate_radps = 0.0,
                         .yaw_rate_std_radps = 0.001};
  const auto covariance = [&](const EgoSample& at) {
    const Mounting mounting = mounting_of(radar(1), &estimate, Config{});
    return ego_velocity(at, vehicle_.ego, radar(1).mounting_pose, mounting).covariance;
  };
  const double straight_with = covariance(sample)(0, 0);
  EgoSample turning = sample;
  turning.yaw_rate_radps = 0.5;
  const double turn_with = covariance(turning)(1, 1);
  estimate.nuisance.range_rate_scale.std = 1e-6F;
  EXPECT_NEAR(straight_with, covariance(sample)(0, 0), 1e-9);
  EXPECT_LT(std::sqrt(straight_with), 0.02);
  const double lever_mps = 0.5 * 3.6;
  EXPECT_NEAR(turn_with - covariance(turning)(1, 1), std::pow(0.002 * lever_mps, 2), 1e-7);
}

TEST_F(RealCar, AnEstimateWithoutRangeRateScaleIsUsedAsItIs) {
  AlignmentEstimate estimate = converged(1, 0.0025);
  estimate.nuisance.range_rate_scale = {};
  ASSERT_TRUE(corrector_.add_alignment(estimate));
  const CorrectedScan& out = correct(1, 0.0, 0.0, -10.0);
  EXPECT_EQ(out.range_rate_mps[0], -10.0F);
  EXPECT_NEAR(out.geometry.speed_scale, estimate.speed_scale, 1e-7);
}

TEST_F(RealCar, TheLoadTurnsDetectionsUpAboutTheVehiclesAxis) {
  AlignmentEstimate estimate = converged(1, 0.0);
  const double load_rad = 0.8 * kRadiansPerDegree;
  estimate.nuisance.load_pitch_rad = {static_cast<float>(load_rad), static_cast<float>(0.05 * kRadiansPerDegree)};
  ASSERT_TRUE(corrector_.add_alignment(estimate));
  // A radar at 45° sees a reflector ahead at −45°: with the nose up, the reflector on the road is lower in its view.
  const Eigen::Vector3d ahead(1.0, 0.0, 0.0);
  const Eigen::Matrix3d body = geometry::sensor_to_vehicle(0.0, load_rad, 0.0);
  const Eigen::Vector3d seen =
      (body * geometry::sensor_to_vehicle(radar(1).mounting_pose, 0.0, 0.0, 0.0)).transpose() * ahead;
  const CorrectedScan& out = correct(1, std::atan2(seen.y(), seen.x()), std::asin(seen.z()), 0.0);
  EXPECT_LT(std::asin(seen.z()), -0.7 * load_rad);
  EXPECT_NEAR(out.elevation_vehicle_rad[0], 0.0, 1e-6);
  EXPECT_NEAR(out.azimuth_vehicle_rad[0], 0.0, 1e-6);
  // Its variance is part of that of the rotation about y.
  EXPECT_NEAR(out.mounting_covariance[3], 1e-7 + std::pow(0.05 * kRadiansPerDegree, 2), 1e-9);
}

TEST_F(RealCar, AnUncertainLoadIsNotAppliedButWidensTheCovariance) {
  AlignmentEstimate estimate = converged(1, 0.0);
  estimate.nuisance.load_pitch_rad = {0.014F, 0.02F};
  const Mounting mounting = mounting_of(radar(1), &estimate, Config{});
  EXPECT_LT((mounting.sensor_to_vehicle - geometry::sensor_to_vehicle(radar(1).mounting_pose, 0.0, 0.0, 0.0)).norm(),
            1e-9);
  EXPECT_NEAR(mounting.covariance(2, 2), 1e-7 + 0.014 * 0.014 + 0.02 * 0.02, 1e-8);
}

TEST_F(RealCar, TheAzimuthCurveIsRemovedBetweenItsKnotsAndClampedBeyond) {
  AlignmentEstimate estimate = converged(1, 0.0);
  AlignmentNuisance& nuisance = estimate.nuisance;
  nuisance.azimuth_curve_first_rad = -1.0F;
  nuisance.azimuth_curve_step_rad = 0.2F;
  for (std::size_t i = 0; i < kAzimuthCurveKnots; ++i) {
    nuisance.azimuth_curve_rad[i] = static_cast<float>(0.001 * (static_cast<double>(i) - 5.0));
    nuisance.azimuth_curve_std_rad[i] = 0.0002F;
  }
  ASSERT_TRUE(corrector_.add_alignment(estimate));
  const double mount = radar(1).mounting_pose.yaw_rad;
  EXPECT_NEAR(correct(1, 0.1, 0.0, 0.0).azimuth_vehicle_rad[0], mount + 0.1 - 0.0005, 1e-6);
  EXPECT_NEAR(correct(1, -0.4, 0.0, 0.0).azimuth_vehicle_rad[0], mount - 0.4 + 0.002, 1e-6);
  EXPECT_NEAR(correct(1, 1.3, 0.0, 0.0).azimuth_vehicle_rad[0], mount + 1.3 - 0.005, 1e-6);
  EXPECT_NEAR(correct(1, -1.3, 0.0, 0.0).azimuth_vehicle_rad[0], mount - 1.3 + 0.005, 1e-6);
}

TEST(AzimuthCurve, IsZeroWithoutAStepOrWithAValueThatIsNoNumber) {
  AlignmentNuisance nuisance{};
  nuisance.azimuth_curve_rad.fill(0.01F);
  EXPECT_EQ(AzimuthCurve(nuisance).at(0.3).value_rad, 0.0);
  nuisance.azimuth_curve_step_rad = 0.2F;
  EXPECT_NEAR(AzimuthCurve(nuisance).at(0.3).value_rad, 0.01, 1e-8);
  nuisance.azimuth_curve_rad[4] = std::nanf("");
  EXPECT_EQ(AzimuthCurve(nuisance).at(0.3).value_rad, 0.0);
}

TEST_F(RealCar, TheYawRateGainActsOnTheLeverArm) {
  AlignmentEstimate estimate = converged(1, 0.0);
  estimate.nuisance.yaw_rate_gain = {0.02F, 0.001F};
  const auto yaw_rate = [&] {
    EXPECT_TRUE(corrector_.add_alignment(estimate));
    return correct(1, 0.0, 0.0, 0.0).geometry.ego_yaw_rate_radps;
  };
  EXPECT_NEAR(yaw_rate(), kYawRate_radps, 1e-6);  // not learnt yet
  estimate.nuisance.observable = alignment_nuisance::kYawRateGain;
  EXPECT_NEAR(yaw_rate(), 1.02 * kYawRate_radps, 1e-6);
}

TEST_F(RealCar, TheTimeOffsetSelectsTheEgoMotion) {
  EgoMotion later{};
  later.header.measurement_time_ns = kMeasured_ns + 100'000'000;
  later.fields = ego_field::kSpeed | ego_field::kYawRate;
  later.speed_mps = static_cast<float>(kSignalled_mps + 1.0);
  later.yaw_rate_radps = static_cast<float>(kYawRate_radps);
  corrector_.add_ego_motion(later);
  AlignmentEstimate estimate = converged(1, 0.0);
  estimate.nuisance.time_offset_s = {0.05F, 0.002F};
  estimate.nuisance.observable = alignment_nuisance::kTimeOffset;
  ASSERT_TRUE(corrector_.add_alignment(estimate));
  EXPECT_NEAR(correct(1, 0.0, 0.0, 0.0).geometry.ego_speed_mps, kTrueScale * (kSignalled_mps + 0.5), 1e-3);
}

}  // namespace
}  // namespace boresight::corrector
