#include "services/health/core/function/disturbance_monitor.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace boresight::health {
namespace {

/// Scans at 20 Hz of a radar whose unexplained detections follow a rate that changes within seconds.
class DisturbanceMonitorTest : public testing::Test {
 protected:
  static constexpr double kSpeed_mps = 14.0;
  static constexpr double kDetections = 120.0;
  static constexpr double kUsual = 10.0;

  /// `added`: random detections of interference in each scan.
  void run(double seconds, double added = 0.0, double speed_mps = kSpeed_mps) {
    std::normal_distribution<double> unit;
    for (int i = 0; i < static_cast<int>(20.0 * seconds); ++i, now_ns_ += 50'000'000) {
      scene_ += -0.02 * scene_ + 0.14 * unit(random_);  // standard deviation 0.7, correlated over 2.5 s
      std::poisson_distribution<int> count(kUsual * std::exp(scene_) + added);
      const double unexplained = count(random_);
      monitor_.observe({.detections = kDetections + unexplained, .unexplained = unexplained}, speed_mps, now_ns_);
      failures_ += monitor_.disturbed() == TestResult::kFailed ? 1 : 0;
    }
  }
  double seconds_until(TestResult result, double added) {
    const std::int64_t begin_ns = now_ns_;
    while (monitor_.disturbed() != result && now_ns_ - begin_ns < 20'000'000'000) run(0.05, added);
    return static_cast<double>(now_ns_ - begin_ns) * 1e-9;
  }
  DisturbanceMonitor monitor_;
  std::mt19937 random_{1};
  double scene_ = 0.0;
  std::int64_t now_ns_ = 1'000'000'000;
  int failures_ = 0;
};

TEST_F(DisturbanceMonitorTest, SaysNothingBeforeTheLevelIsKnown) {
  run(9.0, kDetections);
  EXPECT_EQ(monitor_.disturbed(), TestResult::kNone);
}

TEST_F(DisturbanceMonitorTest, NeverFailsInAnHourOfChangingScenes) {
  run(3600.0);
  EXPECT_EQ(failures_, 0);
  EXPECT_EQ(monitor_.disturbed(), TestResult::kPassed);
}

TEST_F(DisturbanceMonitorTest, AsManyRandomDetectionsAsUsualOnesFailWithinFourSecondsAndPassSoonAfter) {
  run(60.0);
  EXPECT_LT(seconds_until(TestResult::kFailed, kDetections), 4.0);
  run(10.0, kDetections);
  EXPECT_EQ(monitor_.disturbed(), TestResult::kFailed);
  EXPECT_LT(seconds_until(TestResult::kPassed, 0.0), 4.0);
}

TEST_F(DisturbanceMonitorTest, IsJudgedAtStandstillAgainstTheLevelOfTheDrive) {
  run(60.0);
  run(5.0, 0.0, 0.0);
  EXPECT_EQ(monitor_.disturbed(), TestResult::kPassed);
  run(5.0, kDetections, 0.0);
  EXPECT_EQ(monitor_.disturbed(), TestResult::kFailed);
}

TEST_F(DisturbanceMonitorTest, AMinuteOfInterferenceIsNotLearntAsUsual) {
  run(60.0);
  run(60.0, kDetections);
  EXPECT_EQ(monitor_.disturbed(), TestResult::kFailed);
}

TEST_F(DisturbanceMonitorTest, ManyUnexplainedDetectionsAmongFarMoreOthersAreNoDisturbance) {
  run(60.0);
  for (int i = 0; i < 100; ++i, now_ns_ += 50'000'000) {
    monitor_.observe({.detections = 700.0, .unexplained = 140.0}, kSpeed_mps, now_ns_);
  }
  EXPECT_EQ(monitor_.disturbed(), TestResult::kPassed);
}

TEST_F(DisturbanceMonitorTest, ARestoredLevelIsKnownAtOnce) {
  run(60.0);
  const StoredLevel level = monitor_.level();
  monitor_ = DisturbanceMonitor();
  monitor_.restore(level);
  EXPECT_LT(seconds_until(TestResult::kFailed, kDetections), 4.0);
}

}  // namespace
}  // namespace boresight::health
