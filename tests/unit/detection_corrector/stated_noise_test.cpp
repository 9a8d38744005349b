// The ratio of actual to stated range-rate noise in whole drives.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "services/detection_corrector/core/corrector.hpp"
#include "tests/unit/detection_corrector/corrector_scene.hpp"

namespace boresight::corrector {
namespace {

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
  EXPECT_NEAR(out_->range_rate_std_mps[0], 0.288 * learns.range_rate_noise_scale(2), 1e-3) << "of the scan before";
}

TEST_F(StatedNoiseTest, WhatTheRadarDoesNotStateIsNotScaled) {
  VehicleConfig vehicle = one_radar();
  vehicle.radars[0].noise.range_rate_std_mps = 0.288;
  Corrector corrector(vehicle, Config{});
  EXPECT_EQ(walks(corrector, 0.0F, 5.5F, false), 0.0);
  EXPECT_EQ(corrector.range_rate_noise_scale(2), 1.0);
  EXPECT_EQ(corrector.range_rate_noise_scale(3), 1.0) << "unknown radar";
}

TEST_F(StatedNoiseTest, WhatTheAlignmentEstimatorKnowsHoldsFromTheFirstScan) {
  AlignmentEstimate estimate{};
  estimate.header.source_id = 2;
  estimate.nuisance.range_rate_noise_scale = 0.35F;
  Corrector corrector(one_radar(), Config{});
  EXPECT_TRUE(corrector.add_alignment(estimate));
  EXPECT_NEAR(corrector.range_rate_noise_scale(2), 0.35, 1e-6);
  walks(corrector, 0.1F);
  EXPECT_NEAR(corrector.range_rate_noise_scale(2), 1.0, 0.1) << "its own evidence outweighs it";
  for (const float unknown : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
    estimate.nuisance.range_rate_noise_scale = unknown;
    Corrector other(one_radar(), Config{});
    other.add_alignment(estimate);
    EXPECT_EQ(other.range_rate_noise_scale(2), 1.0) << unknown;
  }
  estimate.nuisance.range_rate_noise_scale = 0.35F;
  estimate.finding = AlignmentFinding::kRadarsSwapped;
  Corrector swapped(one_radar(), Config{});
  swapped.add_alignment(estimate);
  EXPECT_EQ(swapped.range_rate_noise_scale(2), 1.0) << "of other detections";
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

}  // namespace
}  // namespace boresight::corrector
