#include "services/health/core/function/unexplained_detections.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"
#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::health {
namespace {

constexpr VehicleMotion kMotion{.speed_mps = 20.0, .yaw_rate_radps = 0.2};
constexpr double kInterval_s = 0.05;

/// A radar at the left front corner that looks 50° to the left.
RadarConfig corner_radar() {
  RadarConfig radar;
  radar.mounting_pose = {.position_m = {3.6, 0.8, 0.6}, .yaw_rad = 0.87, .pitch_rad = 0.03, .roll_rad = 0.0};
  return radar;
}

class UnexplainedDetectionsTest : public testing::Test {
 protected:
  void begin_scan() {
    scan_->number_of_valid_detections = 0;
    scan_->header.measurement_time_ns += static_cast<std::int64_t>(kInterval_s * 1e9);
  }
  void add(double range_m, double azimuth_rad, double range_rate_mps, std::uint16_t flags = 0) {
    const std::uint32_t i = scan_->number_of_valid_detections++;
    scan_->range_m[i] = static_cast<float>(range_m);
    scan_->azimuth_rad[i] = static_cast<float>(azimuth_rad);
    scan_->elevation_rad[i] = 0.0F;
    scan_->range_rate_mps[i] = static_cast<float>(range_rate_mps);
    scan_->detection_flags[i] = flags;
  }
  void add_stationary(double range_m, double azimuth_rad, double error_mps = 0.0) {
    const MountingPose& pose = radar_.mounting_pose;
    const Eigen::Vector3d line =
        geometry::sensor_to_vehicle(pose, 0.0, 0.0, 0.0) * geometry::direction(azimuth_rad, 0.0);
    const Eigen::Vector3d velocity =
        geometry::sensor_velocity(1.0, kMotion.speed_mps, kMotion.yaw_rate_radps, pose.position_m);
    add(range_m, azimuth_rad, geometry::stationary_range_rate(line, velocity) + error_mps);
  }
  void add_random(int count) {
    std::uniform_real_distribution<double> range_m(1.0, 150.0), azimuth_rad(-1.2, 1.2), rate_mps(-80.0, 80.0);
    for (int i = 0; i < count; ++i) add(range_m(random_), azimuth_rad(random_), rate_mps(random_));
  }
  double unexplained(VehicleMotion motion = kMotion) {
    const auto explained = detections_.explain(*scan_, motion);
    return explained ? explained->unexplained : std::numeric_limits<double>::quiet_NaN();
  }

  const RadarConfig radar_ = corner_radar();
  UnexplainedDetections detections_{radar_, {}};
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  std::mt19937 random_{1};
};

TEST_F(UnexplainedDetectionsTest, TheFirstScanHasNoneBefore) {
  begin_scan();
  EXPECT_FALSE(detections_.explain(*scan_, kMotion));
}

TEST_F(UnexplainedDetectionsTest, StationaryReflectorsThatFlickerAreExplainedInABend) {
  std::uniform_real_distribution<double> range_m(2.0, 150.0), azimuth_rad(-1.2, 1.2);
  for (int k = 0; k < 5; ++k) {
    begin_scan();
    for (int i = 0; i < 100; ++i) add_stationary(range_m(random_), azimuth_rad(random_), i % 2 == 0 ? 0.3 : -0.3);
    const double count = unexplained();
    if (k > 0) {
      EXPECT_EQ(count, 0.0);
    }
  }
}

TEST_F(UnexplainedDetectionsTest, AMovingObjectIsSeenAgainWhereItsRangeRatePredicts) {
  for (int k = 0; k < 5; ++k) {
    begin_scan();
    add(100.0 - 70.0 * kInterval_s * k, 0.3, -70.0);
    add(40.0, -0.5, 12.0 + 0.5 * k);
    const double count = unexplained();
    if (k > 0) {
      EXPECT_EQ(count, 0.0);
    }
  }
}

TEST_F(UnexplainedDetectionsTest, RandomDetectionsAreUnexplainedButForAFew) {
  begin_scan();
  add_random(200);
  static_cast<void>(unexplained());
  begin_scan();
  add_random(200);
  for (int i = 0; i < 50; ++i) add_stationary(20.0 + i, 0.01 * i);
  const auto explained = detections_.explain(*scan_, kMotion);
  ASSERT_TRUE(explained);
  EXPECT_EQ(explained->detections, 250.0);
  EXPECT_GT(explained->unexplained, 170.0);
  EXPECT_LE(explained->unexplained, 200.0);
}

TEST_F(UnexplainedDetectionsTest, RangeRatesThatFoldAreComparedWithinTheUnambiguousInterval) {
  scan_->fields |= scan_field::kAmbiguity;
  scan_->range_rate_min_mps = -10.0F;
  scan_->range_rate_max_mps = 10.0F;
  for (int k = 0; k < 2; ++k) {
    begin_scan();
    for (int i = 0; i < 20; ++i) add_stationary(20.0 + 3.0 * (i + k), -1.0 + 0.1 * i, 20.0 * (i % 3 - 1));
    const double count = unexplained();
    if (k > 0) {
      EXPECT_EQ(count, 0.0);
    }
  }
}

TEST_F(UnexplainedDetectionsTest, WithoutSpeedOrAfterAPauseNothingIsKnown) {
  for (int k = 0; k < 2; ++k) {
    begin_scan();
    static_cast<void>(unexplained());
  }
  begin_scan();
  EXPECT_FALSE(detections_.explain(*scan_, {.speed_mps = std::nan(""), .yaw_rate_radps = 0.0}));
  begin_scan();
  EXPECT_FALSE(detections_.explain(*scan_, kMotion)) << "the scan before was not read";
  begin_scan();
  EXPECT_TRUE(detections_.explain(*scan_, kMotion));
  scan_->header.measurement_time_ns += 2'000'000'000;
  EXPECT_FALSE(detections_.explain(*scan_, kMotion)) << "objects have moved on";
}

TEST_F(UnexplainedDetectionsTest, WithoutASignalOfTheDirectionASlowVehicleMayMoveEitherWay) {
  const auto unexplained_in_reverse = [this](double speed_mps, bool is_signed) {
    double count = 0.0;
    for (int k = 0; k < 3; ++k) {
      begin_scan();
      // The vehicle moves backwards, and the reflectors flicker.
      for (int i = 0; i < 20; ++i) add(20.0 + 13.0 * i + 6.5 * (k % 2), -0.87, speed_mps);
      count = unexplained({.speed_mps = speed_mps, .yaw_rate_radps = 0.0, .is_signed = is_signed});
    }
    return count;
  };
  EXPECT_EQ(unexplained_in_reverse(6.0, false), 0.0);
  EXPECT_GT(unexplained_in_reverse(6.0, true), 0.0);
  EXPECT_GT(unexplained_in_reverse(15.0, false), 0.0);
}

TEST_F(UnexplainedDetectionsTest, UnusableDetectionsDoNotCount) {
  for (int k = 0; k < 2; ++k) {
    begin_scan();
    add(30.0 + 40.0 * k, 0.0, 50.0, detection_flag::kUnusable);
    const double count = unexplained();
    if (k > 0) {
      EXPECT_EQ(count, 0.0);
    }
  }
}

TEST_F(UnexplainedDetectionsTest, AFullScanTakesNoAllocation) {
  for (int k = 0; k < 3; ++k) {
    begin_scan();
    add_random(static_cast<int>(kMaxDetections));
    const std::uint64_t before = runtime::counted_allocations();
    static_cast<void>(unexplained());
    EXPECT_EQ(runtime::counted_allocations(), before);
  }
}

}  // namespace
}  // namespace boresight::health
