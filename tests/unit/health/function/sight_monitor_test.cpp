#include "services/health/core/function/sight_monitor.hpp"

#include <random>

#include <gtest/gtest.h>

namespace boresight::health {
namespace {

constexpr double kSpeed_mps = 14.0;
constexpr double kDetections = 45.0;
constexpr double kRange_m = 70.0;

/// Scans at 20 Hz, whose number and range scatter and follow a slowly changing scene.
class SightMonitorTest : public testing::Test {
 protected:
  void run(double seconds, double detections, double range_m, double speed_mps = kSpeed_mps) {
    std::normal_distribution<double> unit;
    for (int i = 0; i < static_cast<int>(20.0 * seconds); ++i, now_ns_ += 50'000'000) {
      scene_ += -0.02 * scene_ + 0.06 * unit(random_);  // standard deviation 0.3, correlated over 2.5 s
      const double count = std::floor(detections * std::exp(scene_ + 0.2 * unit(random_)) + 0.5);
      monitor_.observe({.detections = count, .range_m = range_m * std::exp(0.5 * scene_), .is_sound = is_sound_},
                       speed_mps, now_ns_);
      failures_ += monitor_.reduced() == TestResult::kFailed ? 1 : 0;
    }
  }
  /// Seconds until the test fails; the largest number if it does not within 20 s.
  double seconds_until_blind(double detections, double range_m) {
    const std::int64_t begin_ns = now_ns_;
    while (monitor_.blind() != TestResult::kFailed && now_ns_ - begin_ns < 20'000'000'000)
      run(0.05, detections, range_m);
    return static_cast<double>(now_ns_ - begin_ns) * 1e-9;
  }
  SightMonitor monitor_;
  std::mt19937 random_{1};
  double scene_ = 0.0;
  std::int64_t now_ns_ = 1'000'000'000;
  int failures_ = 0;
  bool is_sound_ = true;
};

TEST_F(SightMonitorTest, SaysNothingBeforeTheLevelIsKnown) {
  run(8.0, 0.0, 0.0);
  EXPECT_EQ(monitor_.blind(), TestResult::kNone);
  EXPECT_FALSE(monitor_.is_known());
}

TEST_F(SightMonitorTest, NeverFailsInAnHourOfChangingScenes) {
  run(600.0, kDetections, kRange_m);
  run(600.0, 0.3 * kDetections, kRange_m);
  run(600.0, 2.0 * kDetections, 0.5 * kRange_m);
  run(600.0, 0.5 * kDetections, 1.3 * kRange_m);
  EXPECT_EQ(failures_, 0);
}

TEST_F(SightMonitorTest, EmptyListsThreeDetectionsAndNearOnesOnlyAreBlindWithinFourSeconds) {
  for (const auto& [detections, range_m] :
       {std::pair{0.0, 0.0}, std::pair{3.0, kRange_m}, std::pair{kDetections, 7.0}}) {
    monitor_ = SightMonitor();
    scene_ = 0.0;
    run(18.0, kDetections, kRange_m);
    ASSERT_EQ(monitor_.blind(), TestResult::kPassed);
    EXPECT_LT(seconds_until_blind(detections, range_m), 4.0) << detections << " detections within " << range_m << " m";
    EXPECT_EQ(monitor_.reduced(), TestResult::kFailed);
  }
}

TEST_F(SightMonitorTest, RecoversWithTheSightAndLearnsNoBlindness) {
  run(60.0, kDetections, kRange_m);
  run(60.0, 1.0, kRange_m);
  EXPECT_EQ(monitor_.blind(), TestResult::kFailed) << "a minute of blindness is not usual";
  run(6.0, kDetections, kRange_m);
  EXPECT_EQ(monitor_.reduced(), TestResult::kPassed);
}

TEST_F(SightMonitorTest, ASlowVehicleIsNotJudgedAndTheVerdictIsTheCallersToKeep) {
  run(20.0, kDetections, kRange_m);
  run(10.0, 0.0, 0.0, 2.0);
  EXPECT_EQ(monitor_.blind(), TestResult::kNone);
  run(10.0, 0.0, 0.0, std::nan(""));
  EXPECT_EQ(monitor_.blind(), TestResult::kNone) << "speed not known";
  run(0.5, kDetections, kRange_m);
  EXPECT_EQ(monitor_.blind(), TestResult::kNone) << "the first second of motion says nothing";
  run(2.0, kDetections, kRange_m);
  EXPECT_EQ(monitor_.blind(), TestResult::kPassed);
}

TEST_F(SightMonitorTest, EmptyListsAndNearOnesFromTheFirstStartAreBlindAfterTheLearningTime) {
  for (const auto& [detections, range_m] :
       {std::pair{0.0, 0.0}, std::pair{1.0, kRange_m}, std::pair{kDetections, 6.0}}) {
    monitor_ = SightMonitor();
    scene_ = 0.0;
    EXPECT_LT(seconds_until_blind(detections, range_m), 13.0) << detections << " detections within " << range_m << " m";
    EXPECT_FALSE(monitor_.is_known()) << "no level is learnt of what a blind radar sees";
    run(2.0, kDetections, kRange_m);
    EXPECT_NE(monitor_.blind(), TestResult::kFailed);
    run(12.0, kDetections, kRange_m);
    EXPECT_EQ(monitor_.blind(), TestResult::kPassed);
  }
}

TEST_F(SightMonitorTest, ARadarThatIsBlindAfterARestartIsFoundByTheKeptLevel) {
  run(60.0, kDetections, kRange_m);
  const SightLevels levels = monitor_.levels();
  monitor_ = SightMonitor();
  monitor_.restore(levels);
  EXPECT_LT(seconds_until_blind(2.0, kRange_m), 2.0);
  monitor_ = SightMonitor();
  monitor_.restore(levels);
  run(2.0, kDetections, kRange_m);
  EXPECT_EQ(monitor_.blind(), TestResult::kPassed);
}

TEST_F(SightMonitorTest, ScansOfDoubtfulIntegrityTeachNoLevel) {
  is_sound_ = false;
  run(60.0, kDetections, kRange_m);
  EXPECT_FALSE(monitor_.is_known());
}

TEST_F(SightMonitorTest, AnEmptyRoadIsNoBlindnessOfARadarThatIsKnownToHaveFew) {
  run(60.0, 5.0, 60.0);
  scene_ = 0.0;
  run(60.0, 0.0, 0.0);
  EXPECT_NE(monitor_.blind(), TestResult::kFailed);
}

TEST_F(SightMonitorTest, ARadarOfFewDetectionsIsMeasuredByItsOwnLevel) {
  run(60.0, 5.0, 60.0);
  EXPECT_EQ(failures_, 0);
  EXPECT_EQ(monitor_.blind(), TestResult::kPassed);
}

}  // namespace
}  // namespace boresight::health
