#include "services/detection_corrector/core/corrector.hpp"

#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/detection_corrector/corrector_scene.hpp"

namespace boresight::corrector {
namespace {

TEST_F(CorrectorTest, RotatedMountIsUndoneExactly) {
  // A point of the vehicle frame, as a sensor with all three angles would see it.
  Corrector corrector(one_radar(-45.0, 3.0, -2.0), Config{});
  const Eigen::Vector3d point(20.0, -9.0, 1.2), mount(3.6, -0.7, 0.5);
  const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(-45.0 * kRadiansPerDegree, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(-3.0 * kRadiansPerDegree, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(-2.0 * kRadiansPerDegree, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  const Eigen::Vector3d seen = rotation.transpose() * (point - mount);
  add(seen.norm(), std::atan2(seen.y(), seen.x()), std::asin(seen.z() / seen.norm()), 0.0);
  corrector.correct(*scan_, *out_);
  EXPECT_NEAR(out_->x_vehicle_m[0], point.x(), 1e-4);
  EXPECT_NEAR(out_->y_vehicle_m[0], point.y(), 1e-4);
  EXPECT_NEAR(out_->z_vehicle_m[0], point.z(), 1e-4);
  const Eigen::Vector3d sight = (point - mount).normalized();
  EXPECT_NEAR(out_->azimuth_vehicle_rad[0], std::atan2(sight.y(), sight.x()), 1e-6);
  EXPECT_NEAR(out_->elevation_vehicle_rad[0], std::asin(sight.z()), 1e-6);
  EXPECT_NEAR(out_->geometry.sensor_position_vehicle_m[1], -0.7, 1e-6);
}

TEST_F(CorrectorTest, EstimateIsAppliedIfCertainEnough) {
  Corrector corrector(one_radar(), Config{});
  ASSERT_TRUE(corrector.add_alignment(yaw_estimate(2.0 * kRadiansPerDegree, 1.01)));
  corrector.add_ego_motion(ego(20.0F, 0.0F));
  add(50.0, 0.0, 0.0, -20.2 * std::cos(2.0 * kRadiansPerDegree));
  corrector.correct(*scan_, *out_);
  EXPECT_NEAR(out_->azimuth_vehicle_rad[0], 2.0 * kRadiansPerDegree, 1e-6);
  EXPECT_NEAR(out_->elevation_vehicle_rad[0], 0.0, 1e-6) << "pitch is not observable";
  EXPECT_NEAR(out_->range_rate_over_ground_mps[0], 0.0, 1e-5);
  EXPECT_EQ(out_->alignment_sequence, 77u);
  EXPECT_EQ(out_->flags, 0u);
  EXPECT_NEAR(out_->geometry.ego_speed_mps, 20.2, 1e-5);

  AlignmentEstimate unsure = yaw_estimate(3.0 * kRadiansPerDegree, 1.01);
  unsure.covariance[5] = 1e-3F;  // 1.8°
  unsure.observable = alignment_axis::kYaw;
  Corrector other(one_radar(), Config{});
  ASSERT_TRUE(other.add_alignment(unsure));
  other.correct(*scan_, *out_);
  EXPECT_NEAR(out_->azimuth_vehicle_rad[0], 0.0, 1e-6);
  EXPECT_TRUE(out_->flags & pipeline_flag::kNoAlignment);
}

TEST_F(CorrectorTest, StationaryReflectorsHaveNoRangeRateOverGround) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> azimuth(-1.2, 1.2), elevation(-0.2, 0.2), angle(-3.0, 3.0);
  const double yaw = 1.7 * kRadiansPerDegree, scale = 1.012;
  Corrector corrector(one_radar(135.0, 2.0, 1.0), Config{});
  ASSERT_TRUE(corrector.add_alignment(yaw_estimate(yaw, scale)));
  corrector.add_ego_motion(ego(14.0F, 0.4F));
  const Eigen::Matrix3d rotation =
      geometry::sensor_to_vehicle(135.0 * kRadiansPerDegree + yaw, 2.0 * kRadiansPerDegree, 1.0 * kRadiansPerDegree);
  const Eigen::Vector3d velocity(scale * 14.0 + 0.4 * 0.7, 0.4 * 3.6, 0.0);
  for (int i = 0; i < 500; ++i) {
    const double a = azimuth(random), e = elevation(random);
    add(30.0, a, e, -(rotation * geometry::direction(a, e)).dot(velocity));
  }
  corrector.correct(*scan_, *out_);
  for (std::size_t i = 0; i < 500; ++i) {
    ASSERT_NEAR(out_->range_rate_over_ground_mps[i], 0.0, 1e-4);
    ASSERT_TRUE(out_->detection_flags[i] & corrected_flag::kStationary);
    ASSERT_FALSE(out_->detection_flags[i] & corrected_flag::kMoving);
  }
}

TEST_F(CorrectorTest, MovingThresholdByHand) {
  // Straight ahead at 10 m/s with σ of 0.001 for k_v and 0.03 m/s for ego speed and range rates: angles have no
  // effect.
  const Config config;
  const double std = std::sqrt(0.03 * 0.03 + 0.03 * 0.03 + 0.01 * 0.01 + std::pow(config.body_motion_std_mps, 2));
  const double threshold = config.moving_sigma * std;
  Corrector corrector(one_radar(), config);
  ASSERT_TRUE(corrector.add_alignment(yaw_estimate(0.0, 1.0)));
  corrector.add_ego_motion(ego(10.0F, 0.0F));
  add(50.0, 0.0, 0.0, -10.0 + threshold - 0.01);
  add(50.0, 0.0, 0.0, -10.0 + threshold + 0.01);
  add(50.0, 0.0, 0.0, -10.0 - threshold - 0.01);
  add(50.0, 60.0 * kRadiansPerDegree, 0.0, -5.0 + threshold + 0.01);  // here the noise of the azimuth has an effect too
  corrector.correct(*scan_, *out_);
  EXPECT_TRUE(out_->detection_flags[0] & corrected_flag::kStationary);
  EXPECT_TRUE(out_->detection_flags[1] & corrected_flag::kMoving);
  EXPECT_TRUE(out_->detection_flags[2] & corrected_flag::kMoving);
  EXPECT_TRUE(out_->detection_flags[3] & corrected_flag::kStationary);
  // The covariance of the remaining mounting error is published.
  EXPECT_NEAR(out_->speed_scale_std, 1e-3, 1e-6);
  EXPECT_NEAR(out_->mounting_covariance[5], 1e-7, 1e-9);
  EXPECT_NEAR(out_->mounting_covariance[3], 0.005, 1e-6);
}

TEST_F(CorrectorTest, YawRateBiasAndSlipOfTheEstimateAreRemoved) {
  Corrector corrector(one_radar(), Config{});
  AlignmentEstimate e = yaw_estimate(0.0, 1.0);
  e.observable |= alignment_axis::kYawRateBias | alignment_axis::kSlip;
  e.yaw_rate_bias_radps = 0.02F;
  e.slip_coefficient_radps2pm = 0.004F;
  e.yaw_rate_bias_std_radps = e.slip_coefficient_std_radps2pm = 1e-4F;
  ASSERT_TRUE(corrector.add_alignment(e));
  corrector.add_ego_motion(ego(20.0F, 0.22F));
  // True yaw rate 0.2 rad/s: the sensor moves by 20 + 0.2·0.7 ahead and 0.2·3.6 − 0.004·400·0.2 to the left.
  add(50.0, 0.0, 0.0, -20.14);
  add(50.0, 90.0 * kRadiansPerDegree, 0.0, -0.4);
  corrector.correct(*scan_, *out_);
  EXPECT_NEAR(out_->range_rate_over_ground_mps[0], 0.0, 1e-4);
  EXPECT_NEAR(out_->range_rate_over_ground_mps[1], 0.0, 1e-4);
  EXPECT_NEAR(out_->geometry.ego_yaw_rate_radps, 0.2, 1e-6);
}

TEST_F(CorrectorTest, EachReasonForRejectionHasItsFlag) {
  Config config;
  config.rcs_near_dbsm = -5.0;
  config.rcs_slope_db_per_decade = -10.0;  // near detections must be stronger
  Corrector corrector(one_radar(), config);
  corrector.add_ego_motion(ego(10.0F, 0.0F));
  add(50.0, 0.0, 0.0, -10.0);
  add(250.0, 0.0, 0.0, -10.0);                     // outside the box
  add(30.0, 0.0, 20.0 * kRadiansPerDegree, -9.4);  // above it
  add(10.0, 0.0, 0.0, -10.0, -6.0);                // limit −5 at 10 m
  add(40.0, 0.0, 0.0, -10.0, -10.0);               // limit −11 at 40 m
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->detection_flags[0], corrected_flag::kStationary);
  EXPECT_TRUE(out_->detection_flags[1] & corrected_flag::kOutsideRegion);
  EXPECT_TRUE(out_->detection_flags[2] & corrected_flag::kOutsideRegion);
  EXPECT_TRUE(out_->detection_flags[3] & corrected_flag::kWeak);
  EXPECT_FALSE(out_->detection_flags[4] & corrected_flag::kWeak);
}

TEST_F(CorrectorTest, TheSensorsVerdictsAreCarriedOverAndRejectNothing) {
  Corrector corrector(one_radar(), Config{});
  corrector.add_ego_motion(ego(10.0F, 0.0F));
  struct Case {
    std::uint16_t by_sensor, expected;
  };
  const Case cases[] = {
      {detection_flag::kInvalid, corrected_flag::kDoubted},
      {detection_flag::kAmbiguous, corrected_flag::kAmbiguous},
      {detection_flag::kInvalid | detection_flag::kAmbiguous, corrected_flag::kDoubted | corrected_flag::kAmbiguous}};
  for (const Case& c : cases) {
    for (const double range_rate : {-10.0, -25.0}) {
      scan_->number_of_valid_detections = 0;
      add(50.0, 0.0, 0.0, range_rate);
      scan_->detection_flags[0] = c.by_sensor;
      corrector.correct(*scan_, *out_);
      const std::uint16_t motion = range_rate == -10.0 ? corrected_flag::kStationary : corrected_flag::kMoving;
      EXPECT_EQ(out_->detection_flags[0], c.expected | motion) << c.by_sensor;
      EXPECT_EQ(out_->detection_flags[0] & corrected_flag::kRejected, 0);
    }
  }
  scan_->number_of_valid_detections = 0;
  add(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0, -10.0);
  scan_->detection_flags[0] = detection_flag::kInvalid;
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->detection_flags[0] & (corrected_flag::kInvalid | corrected_flag::kDoubted | corrected_flag::kMoving |
                                        corrected_flag::kStationary),
            corrected_flag::kInvalid | corrected_flag::kDoubted);
}

TEST_F(CorrectorTest, AnUnusableDetectionIsRejectedAlthoughItsValuesAreFinite) {
  Corrector corrector(one_radar(), Config{});
  corrector.add_ego_motion(ego(10.0F, 0.0F));
  add(50.0, 0.0, 0.0, -10.0);
  scan_->detection_flags[0] = detection_flag::kUnusable;
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->detection_flags[0], corrected_flag::kInvalid);
}

TEST_F(CorrectorTest, MissingSideInputsAreFlagged) {
  Corrector corrector(one_radar(), Config{});
  add(50.0, 0.0, 0.0, -10.0);
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->flags, pipeline_flag::kNoAlignment | pipeline_flag::kNoEgoMotion);
  EXPECT_EQ(out_->detection_flags[0], 0) << "neither moving nor stationary";
  EXPECT_EQ(out_->range_rate_over_ground_mps[0], -10.0F) << "not compensated";
  corrector.add_ego_motion(ego(10.0F, 0.0F, kTime - 300'000'000));
  AlignmentEstimate old = yaw_estimate(0.0, 1.0);
  old.header.measurement_time_ns = kTime - 3'000'000'000;
  ASSERT_TRUE(corrector.add_alignment(old));
  scan_->fields = 0;
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->flags, pipeline_flag::kAlignmentStale | pipeline_flag::kEgoMotionStale | pipeline_flag::kNoElevation);
  EXPECT_EQ(out_->geometry.ego_speed_mps, 0.0F);
}

TEST_F(CorrectorTest, ScanThatIsProvenWrongIsDistrustedAndItsDetectionsAreInvalid) {
  using namespace scan_integrity;
  Corrector corrector(one_radar(), Config{});
  corrector.add_ego_motion(ego(20.0F, 0.0F));
  add(50.0, 0.0, 0.0, -20.0);
  const auto is_distrusted = [&] {
    corrector.correct(*scan_, *out_);
    const bool is_invalid = out_->detection_flags[0] == corrected_flag::kInvalid;
    EXPECT_EQ((out_->flags & pipeline_flag::kDistrusted) != 0, is_invalid);
    return is_invalid;
  };
  EXPECT_FALSE(is_distrusted());
  for (std::size_t bit = 0; bit < kNumberOfBits; ++bit) {
    scan_->integrity = static_cast<std::uint16_t>(1U << bit);
    EXPECT_EQ(is_distrusted(), (scan_->integrity & (kRepeated | kFrozen | kContradictsEgo | kImpossibleCopies)) != 0);
  }
  scan_->integrity = 0;
  AlignmentEstimate estimate = yaw_estimate(0.0, 1.0);
  for (const auto& [finding, is_wrong] :
       {std::pair{AlignmentFinding::kAzimuthMirrored, true}, std::pair{AlignmentFinding::kRadarsSwapped, true},
        std::pair{AlignmentFinding::kSpeedUnit, false}, std::pair{AlignmentFinding::kNone, false}}) {
    estimate.finding = finding;
    ASSERT_TRUE(corrector.add_alignment(estimate));
    EXPECT_EQ(is_distrusted(), is_wrong) << static_cast<int>(finding);
  }
}

TEST_F(CorrectorTest, NonFiniteValuesAreInvalidAndDoNotAffectOthers) {
  Corrector corrector(one_radar(), Config{});
  corrector.add_ego_motion(ego(10.0F, 0.0F));
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  add(nan, 0.0, 0.0, -10.0);
  add(50.0, infinity, 0.0, -10.0);
  add(50.0, 0.0, nan, -10.0);
  add(50.0, 0.0, 0.0, nan);
  add(-1.0, 0.0, 0.0, -10.0);
  add(50.0, 0.0, 0.0, -10.0);
  corrector.correct(*scan_, *out_);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(out_->detection_flags[i] & corrected_flag::kInvalid) << i;
    EXPECT_TRUE(std::isfinite(out_->x_vehicle_m[i]) && std::isfinite(out_->range_rate_over_ground_mps[i])) << i;
  }
  EXPECT_EQ(out_->detection_flags[5], corrected_flag::kStationary);
}

TEST_F(CorrectorTest, UnknownRadarGivesAnEmptyScanAndAFullOneFits) {
  Corrector corrector(one_radar(), Config{});
  AlignmentEstimate unknown = yaw_estimate(0.0, 1.0);
  unknown.header.source_id = 9;
  EXPECT_FALSE(corrector.add_alignment(unknown));
  for (std::uint32_t i = 0; i < kMaxDetections; ++i) add(20.0, 0.0, 0.0, -10.0);
  scan_->number_of_valid_detections = 5000;  // a scan with a wrong length
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->number_of_valid_detections, kMaxDetections);
  scan_->header.source_id = 9;
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->number_of_valid_detections, 0u);
}

TEST_F(CorrectorTest, QuarterTurnsByHand) {
  // Mounted to the left at (3.6, −0.7, 0.5): a reflector ahead of it is at the vehicle's left, one at its left is
  // behind, and one above it is above.
  Corrector corrector(one_radar(90.0), Config{});
  add(10.0, 0.0, 0.0, -1.0);
  add(10.0, 90.0 * kRadiansPerDegree, 0.0, -1.0);
  add(2.0, 0.0, 90.0 * kRadiansPerDegree, -1.0);
  corrector.correct(*scan_, *out_);
  const double expected[3][3] = {{3.6, 9.3, 0.5}, {-6.4, -0.7, 0.5}, {3.6, -0.7, 2.5}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(out_->x_vehicle_m[i], expected[i][0], 1e-5) << i;
    EXPECT_NEAR(out_->y_vehicle_m[i], expected[i][1], 1e-5) << i;
    EXPECT_NEAR(out_->z_vehicle_m[i], expected[i][2], 1e-5) << i;
  }
  EXPECT_NEAR(out_->azimuth_vehicle_rad[0], 90.0 * kRadiansPerDegree, 1e-6);
  EXPECT_NEAR(std::abs(out_->azimuth_vehicle_rad[1]), M_PI, 1e-6);
}

TEST_F(CorrectorTest, LeverArmByHand) {
  // Turning left at 0.5 rad/s on the spot, 3.6 m ahead of and 0.7 m to the right of the axle: the sensor moves at
  // 0.5 · 0.7 forward and 0.5 · 3.6 to the left.
  Corrector corrector(one_radar(), Config{});
  corrector.add_ego_motion(ego(0.0F, 0.5F));
  add(20.0, 0.0, 0.0, -0.35);
  add(20.0, 90.0 * kRadiansPerDegree, 0.0, -1.8);
  add(20.0, -90.0 * kRadiansPerDegree, 0.0, 1.8);
  corrector.correct(*scan_, *out_);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(out_->range_rate_over_ground_mps[i], 0.0, 1e-5) << i;
  EXPECT_NEAR(out_->geometry.sensor_velocity_vehicle_mps[0], 0.35, 1e-6);
  EXPECT_NEAR(out_->geometry.sensor_velocity_vehicle_mps[1], 1.8, 1e-6);
}

TEST_F(CorrectorTest, TheInverseGivesTheMeasuredValues) {
  // From the output alone, with the geometry that it states, back to the values of the sensor.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> azimuth(-1.3, 1.3), elevation(-0.3, 0.3), range(1.0, 90.0), rate(-30.0, 30.0);
  Corrector corrector(one_radar(-135.0, -2.0, 4.0), Config{});
  ASSERT_TRUE(corrector.add_alignment(yaw_estimate(-1.1 * kRadiansPerDegree, 0.99)));
  corrector.add_ego_motion(ego(25.0F, -0.2F));
  for (int i = 0; i < 300; ++i) add(range(random), azimuth(random), elevation(random), rate(random));
  corrector.correct(*scan_, *out_);
  Eigen::Matrix3d rotation;
  Eigen::Vector3d position, velocity;
  for (Eigen::Index row = 0; row < 3; ++row) {
    position(row) = out_->geometry.sensor_position_vehicle_m[static_cast<std::size_t>(row)];
    velocity(row) = out_->geometry.sensor_velocity_vehicle_mps[static_cast<std::size_t>(row)];
    for (Eigen::Index column = 0; column < 3; ++column) {
      rotation(row, column) = out_->geometry.sensor_to_vehicle[static_cast<std::size_t>(3 * row + column)];
    }
  }
  EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-6);
  EXPECT_NEAR(rotation.determinant(), 1.0, 1e-6);
  for (std::size_t i = 0; i < 300; ++i) {
    const Eigen::Vector3d place(out_->x_vehicle_m[i], out_->y_vehicle_m[i], out_->z_vehicle_m[i]);
    const Eigen::Vector3d seen = rotation.transpose() * (place - position);
    EXPECT_NEAR(seen.norm(), scan_->range_m[i], 2e-5 * scan_->range_m[i] + 1e-5);
    EXPECT_NEAR(std::atan2(seen.y(), seen.x()), scan_->azimuth_rad[i], 2e-5);
    EXPECT_NEAR(std::asin(seen.z() / seen.norm()), scan_->elevation_rad[i], 2e-5);
    const double measured =
        out_->range_rate_over_ground_mps[i] - seen.normalized().dot(rotation.transpose() * velocity);
    EXPECT_NEAR(measured, scan_->range_rate_mps[i], 1e-3);
  }
}

TEST_F(CorrectorTest, NonFiniteSideInputsAreNotApplied) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  add(50.0, 10.0 * kRadiansPerDegree, 0.0, -10.0 * std::cos(10.0 * kRadiansPerDegree));
  for (int what = 0; what < 4; ++what) {
    Corrector corrector(one_radar(), Config{});
    AlignmentEstimate bad = yaw_estimate(2.0 * kRadiansPerDegree, 1.01);
    if (what == 0) bad.vehicle_yaw_rad = bad.speed_scale = nan;
    if (what == 1) bad.covariance[0] = bad.vehicle_covariance[5] = nan;
    if (what == 2) bad.covariance[0] = bad.vehicle_covariance[5] = -1.0F;
    if (what == 3) bad.observable = 0;
    ASSERT_TRUE(corrector.add_alignment(bad));
    corrector.add_ego_motion(ego(10.0F, 0.0F));
    corrector.add_ego_motion(ego(nan, 0.0F, kTime + 10'000'000));
    corrector.correct(*scan_, *out_);
    EXPECT_EQ(out_->flags, pipeline_flag::kNoAlignment) << what;
    EXPECT_NEAR(out_->azimuth_vehicle_rad[0], 10.0 * kRadiansPerDegree, 1e-6) << what;
    EXPECT_NEAR(out_->range_rate_over_ground_mps[0], 0.0, 1e-5) << what;
    EXPECT_EQ(out_->detection_flags[0], corrected_flag::kStationary) << what;
  }
}

TEST_F(CorrectorTest, StatedStdsAreUsedIfTheyAreNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Corrector corrector(one_radar(), Config{});
  corrector.add_ego_motion(ego(10.0F, 0.0F));
  for (int i = 0; i < 3; ++i) add(50.0, 0.0, 0.0, -11.5);
  scan_->fields |= scan_field::kStds;
  const float stds[] = {0.7F, nan, 0.0F};
  for (std::size_t i = 0; i < 3; ++i) {
    scan_->range_std_m[i] = scan_->azimuth_std_rad[i] = scan_->elevation_std_rad[i] = scan_->range_rate_std_mps[i] =
        stds[i];
  }
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->range_rate_std_mps[0], 0.7F);
  EXPECT_TRUE(out_->detection_flags[0] & corrected_flag::kStationary) << "1.5 m/s is within three stds";
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ(out_->range_rate_std_mps[i], 0.03F) << "that of the vehicle file";
    EXPECT_EQ(out_->range_std_m[i], 0.1F);
    EXPECT_TRUE(out_->detection_flags[i] & corrected_flag::kMoving);
  }
}

TEST_F(CorrectorTest, EachFaceOfTheBoxIsALimit) {
  Config config;
  config.region_min_m = {-10.0, -5.0, -1.0};
  config.region_max_m = {30.0, 6.0, 3.0};
  Corrector corrector(one_radar(), config);
  const Eigen::Vector3d mount(3.6, -0.7, 0.5);
  std::vector<bool> inside;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double beyond : {-0.01, 0.01}) {
      for (const bool upper : {false, true}) {
        Eigen::Vector3d point(10.0, 1.0, 1.0);
        const auto k = static_cast<std::size_t>(axis);
        point(axis) = (upper ? config.region_max_m[k] : config.region_min_m[k]) + beyond;
        inside.push_back(upper == (beyond < 0.0));
        const Eigen::Vector3d seen = point - mount;
        add(seen.norm(), std::atan2(seen.y(), seen.x()), std::asin(seen.z() / seen.norm()), 0.0);
      }
    }
  }
  corrector.correct(*scan_, *out_);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    EXPECT_EQ((out_->detection_flags[i] & corrected_flag::kOutsideRegion) == 0, inside[i]) << i;
  }
}

TEST_F(CorrectorTest, RcsIsComparedOnlyIfKnown) {
  Config config;
  config.rcs_near_dbsm = -25.0;
  Corrector corrector(one_radar(), config);
  add(50.0, 0.0, 0.0, 0.0, std::numeric_limits<double>::quiet_NaN());
  add(50.0, 0.0, 0.0, 0.0, -25.1);
  add(50.0, 0.0, 0.0, 0.0, -24.9);
  corrector.correct(*scan_, *out_);
  EXPECT_FALSE(out_->detection_flags[0] & corrected_flag::kWeak) << "an RCS that is not a number says nothing";
  EXPECT_TRUE(out_->detection_flags[1] & corrected_flag::kWeak);
  EXPECT_FALSE(out_->detection_flags[2] & corrected_flag::kWeak);
  scan_->fields = scan_field::kElevation;
  corrector.correct(*scan_, *out_);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(out_->detection_flags[i] & corrected_flag::kWeak) << i;
}

TEST_F(CorrectorTest, NoDetectionIsWeakUnlessTheIntegratorSetsALimit) {
  Corrector corrector(one_radar(), Config{});
  for (const double rcs_dbsm : {-90.0, -40.0, 0.0}) {
    for (const double range_m : {1.0, 10.0, 150.0}) add(range_m, 0.0, 0.0, 0.0, rcs_dbsm);
  }
  corrector.correct(*scan_, *out_);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_FALSE(out_->detection_flags[i] & corrected_flag::kWeak) << i;
}

TEST_F(CorrectorTest, AllocatesNothing) {
  Corrector corrector(one_radar(), Config{});
  scan_->fields |= scan_field::kStds;
  for (std::uint32_t i = 0; i < kMaxDetections; ++i) add(20.0, 0.0, 0.0, -10.0);
  scan_->range_rate_std_mps[0] = 0.1F;
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    corrector.add_ego_motion(ego(10.0F, 0.0F));
    static_cast<void>(corrector.add_alignment(yaw_estimate(0.01, 1.0)));
    corrector.correct(*scan_, *out_);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::corrector
