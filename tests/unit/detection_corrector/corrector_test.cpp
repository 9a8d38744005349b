#include "services/detection_corrector/core/corrector.hpp"

#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::corrector {
namespace {

constexpr std::int64_t kTime = 1'000'000'000'000;

VehicleConfig one_radar(double yaw_deg = 0.0, double pitch_deg = 0.0, double roll_deg = 0.0) {
  VehicleConfig vehicle;
  RadarConfig radar;
  radar.id = 2;
  radar.mounting_pose = {
      {3.6, -0.7, 0.5}, yaw_deg * kRadiansPerDegree, pitch_deg * kRadiansPerDegree, roll_deg * kRadiansPerDegree};
  radar.noise = {.range_std_m = 0.1,
                 .azimuth_std_rad = 0.2 * kRadiansPerDegree,
                 .elevation_std_rad = 0.3 * kRadiansPerDegree,
                 .range_rate_std_mps = 0.03};
  vehicle.radars.push_back(radar);
  return vehicle;
}

EgoMotion ego(float speed, float yaw_rate, std::int64_t time_ns = kTime) {
  EgoMotion m{};
  m.header.measurement_time_ns = time_ns;
  m.fields = ego_field::kSpeed | ego_field::kYawRate;
  m.speed_mps = speed;
  m.speed_std_mps = 0.03F;
  m.yaw_rate_radps = yaw_rate;
  m.yaw_rate_std_radps = 0.002F;
  return m;
}

AlignmentEstimate estimate(double yaw_rad, double scale) {
  AlignmentEstimate e{};
  e.header.source_id = 2;
  e.header.sequence = 77;
  e.header.measurement_time_ns = kTime;
  e.state = AlignmentState::kConverged;
  e.observable = alignment_axis::kYaw | alignment_axis::kVehicleYaw | alignment_axis::kSpeedScale;
  e.alignment_yaw_rad = e.vehicle_yaw_rad = static_cast<float>(yaw_rad);
  e.alignment_pitch_rad = e.vehicle_pitch_rad = 0.5F;  // not observable: must not be applied
  e.speed_scale = static_cast<float>(scale);
  e.covariance[0] = 1e-6F;
  e.covariance[5] = 1e-7F;
  e.covariance[10] = e.covariance[15] = 0.005F;
  e.vehicle_covariance = e.covariance;
  return e;
}

class CorrectorTest : public testing::Test {
 protected:
  CorrectorTest() {
    std::memset(static_cast<void*>(out_.get()), 0xCD, sizeof(CorrectedScan));  // a chunk holds stale data
    scan_->header = {};
    scan_->header.source_id = 2;
    scan_->header.measurement_time_ns = kTime;
    scan_->fields = scan_field::kElevation | scan_field::kRcs;
    scan_->number_of_valid_detections = 0;
  }
  void add(double range, double azimuth, double elevation, double range_rate, double rcs = 10.0) {
    const std::uint32_t i = scan_->number_of_valid_detections++;
    scan_->range_m[i] = static_cast<float>(range);
    scan_->azimuth_rad[i] = static_cast<float>(azimuth);
    scan_->elevation_rad[i] = static_cast<float>(elevation);
    scan_->range_rate_mps[i] = static_cast<float>(range_rate);
    scan_->rcs_dbsm[i] = static_cast<float>(rcs);
    scan_->snr_db[i] = 20.0F;
    scan_->detection_flags[i] = 0;
  }
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  std::unique_ptr<CorrectedScan> out_ = std::make_unique<CorrectedScan>();
};

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
  ASSERT_TRUE(corrector.add_alignment(estimate(2.0 * kRadiansPerDegree, 1.01)));
  corrector.add_ego_motion(ego(20.0F, 0.0F));
  add(50.0, 0.0, 0.0, -20.2 * std::cos(2.0 * kRadiansPerDegree));
  corrector.correct(*scan_, *out_);
  EXPECT_NEAR(out_->azimuth_vehicle_rad[0], 2.0 * kRadiansPerDegree, 1e-6);
  EXPECT_NEAR(out_->elevation_vehicle_rad[0], 0.0, 1e-6) << "pitch is not observable";
  EXPECT_NEAR(out_->range_rate_over_ground_mps[0], 0.0, 1e-5);
  EXPECT_EQ(out_->alignment_sequence, 77u);
  EXPECT_EQ(out_->flags, 0u);
  EXPECT_NEAR(out_->geometry.ego_speed_mps, 20.2, 1e-5);

  AlignmentEstimate unsure = estimate(3.0 * kRadiansPerDegree, 1.01);
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
  ASSERT_TRUE(corrector.add_alignment(estimate(yaw, scale)));
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
  ASSERT_TRUE(corrector.add_alignment(estimate(0.0, 1.0)));
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
  AlignmentEstimate e = estimate(0.0, 1.0);
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

TEST_F(CorrectorTest, MissingSideInputsAreFlagged) {
  Corrector corrector(one_radar(), Config{});
  add(50.0, 0.0, 0.0, -10.0);
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->flags, pipeline_flag::kNoAlignment | pipeline_flag::kNoEgoMotion);
  EXPECT_EQ(out_->detection_flags[0], 0) << "neither moving nor stationary";
  EXPECT_EQ(out_->range_rate_over_ground_mps[0], -10.0F) << "not compensated";
  corrector.add_ego_motion(ego(10.0F, 0.0F, kTime - 300'000'000));
  AlignmentEstimate old = estimate(0.0, 1.0);
  old.header.measurement_time_ns = kTime - 3'000'000'000;
  ASSERT_TRUE(corrector.add_alignment(old));
  scan_->fields = 0;
  corrector.correct(*scan_, *out_);
  EXPECT_EQ(out_->flags, pipeline_flag::kAlignmentStale | pipeline_flag::kEgoMotionStale | pipeline_flag::kNoElevation);
  EXPECT_EQ(out_->geometry.ego_speed_mps, 0.0F);
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
  AlignmentEstimate unknown = estimate(0.0, 1.0);
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
  ASSERT_TRUE(corrector.add_alignment(estimate(-1.1 * kRadiansPerDegree, 0.99)));
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
    AlignmentEstimate bad = estimate(2.0 * kRadiansPerDegree, 1.01);
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

class StatedNoiseTest : public CorrectorTest {
 protected:
  /// Drives past stationary reflectors with noise of 0.1 m/s, and somebody who walks away at 0.9 m/s. The radar states
  /// `stated_mps`. Returns the share of the last scans in which the pedestrian is moving.
  double walks(Corrector& corrector, float stated_mps, float speed_mps = 5.5F, bool has_stds = true,
               std::uint16_t verdict = 0) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 0.1);
    std::uniform_real_distribution<double> azimuth(-0.5, 0.5);
    scan_->fields = scan_field::kElevation | (has_stds ? scan_field::kStds : 0u);
    constexpr int kScans = 200, kLast = 50;
    int moving = 0;
    for (int s = 0; s < kScans; ++s) {
      const std::int64_t time_ns = kTime + s * 75'000'000LL;
      corrector.add_ego_motion(ego(speed_mps, 0.0F, time_ns));
      scan_->header.measurement_time_ns = time_ns;
      scan_->number_of_valid_detections = 0;
      add(15.0, 0.0, 0.0, -speed_mps + 0.9);
      for (int i = 0; i < 40; ++i) {
        const double a = azimuth(random);
        add(30.0, a, 0.0, -speed_mps * std::cos(a) + noise(random));
      }
      for (std::uint32_t i = 0; i < scan_->number_of_valid_detections; ++i) {
        scan_->range_std_m[i] = 0.2F;
        scan_->azimuth_std_rad[i] = scan_->elevation_std_rad[i] = 0.005F;
        scan_->range_rate_std_mps[i] = stated_mps;
        scan_->detection_flags[i] = verdict;
      }
      corrector.correct(*scan_, *out_);
      if (s >= kScans - kLast && (out_->detection_flags[0] & corrected_flag::kMoving) != 0) ++moving;
    }
    return static_cast<double>(moving) / kLast;
  }
};

TEST_F(StatedNoiseTest, APedestrianIsFoundAlthoughTheRadarStatesTooWideANoise) {
  Config fixed;
  fixed.stated_noise.least_scale = fixed.stated_noise.most_scale = 1.0;
  Corrector learns(one_radar(), Config{}), stated(one_radar(), fixed);
  EXPECT_EQ(walks(stated, 0.288F), 0.0);
  EXPECT_EQ(walks(learns, 0.288F), 1.0);
  EXPECT_NEAR(learns.range_rate_noise_scale(2), 0.1 / 0.288, 0.1);
  EXPECT_EQ(out_->range_rate_std_mps[0], 0.288F) << "later services receive what the radar states";
}

TEST_F(StatedNoiseTest, WhatTheRadarDoesNotStateIsNotScaled) {
  VehicleConfig vehicle = one_radar();
  vehicle.radars[0].noise.range_rate_std_mps = 0.288;
  Corrector corrector(vehicle, Config{});
  EXPECT_EQ(walks(corrector, 0.0F, 5.5F, false), 0.0);
  EXPECT_EQ(corrector.range_rate_noise_scale(2), 1.0);
  EXPECT_EQ(corrector.range_rate_noise_scale(3), 1.0) << "unknown radar";
}

TEST_F(StatedNoiseTest, NothingIsLearntOfDetectionsThatTheSensorDoubts) {
  for (const std::uint16_t verdict : {detection_flag::kInvalid, detection_flag::kAmbiguous}) {
    Corrector corrector(one_radar(), Config{});
    walks(corrector, 0.288F, 5.5F, true, verdict);
    EXPECT_EQ(corrector.range_rate_noise_scale(2), 1.0) << verdict;
  }
}

TEST_F(StatedNoiseTest, NothingIsLearntInAStandingVehicle) {
  Corrector corrector(one_radar(), Config{});
  walks(corrector, 0.288F, 0.0F);
  EXPECT_EQ(corrector.range_rate_noise_scale(2), 1.0);
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
    static_cast<void>(corrector.add_alignment(estimate(0.01, 1.0)));
    corrector.correct(*scan_, *out_);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::corrector
