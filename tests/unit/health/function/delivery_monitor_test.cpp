#include "services/health/core/function/delivery_monitor.hpp"

#include <random>

#include <gtest/gtest.h>

namespace boresight::health {
namespace {

constexpr std::int64_t kStart_ns = 1'000'000'000'000;
constexpr std::int64_t kCycle_ns = 50'000'000;
constexpr std::int64_t kStep_ns = 10'000'000;

/// A radar of 20 Hz with a deadline of 0.25 s.
class DeliveryMonitorTest : public testing::Test {
 protected:
  /// Lets time pass; in each cycle a scan arrives with this probability, or as many as `per_cycle`.
  void run(double seconds, double probability = 1.0, int per_cycle = 1, std::int64_t age_ns = 10'000'000) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const std::int64_t end_ns = now_ns_ + static_cast<std::int64_t>(seconds * 1e9);
    for (; now_ns_ < end_ns; now_ns_ += kStep_ns) {
      if ((now_ns_ - kStart_ns) % kCycle_ns == 0 && share(random_) < probability) {
        for (int i = 0; i < per_cycle; ++i) monitor_.observe(age_ns, now_ns_);
      }
      const TestResult silent = monitor_.silent(now_ns_);
      flips_ += silent == was_silent_ ? 0 : 1;
      was_silent_ = silent;
      if (silent == TestResult::kFailed) silent_s_ += 0.01;
    }
  }
  DeliveryMonitor monitor_{DeliveryConfig{}, 20.0, 0.25, 0.0, 2.0, kStart_ns};
  std::mt19937 random_{1};
  std::int64_t now_ns_ = kStart_ns;
  TestResult was_silent_ = TestResult::kNone;
  int flips_ = 0;
  double silent_s_ = 0.0;
};

TEST_F(DeliveryMonitorTest, AHealthyRadarPassesEachTest) {
  run(5.0);
  EXPECT_EQ(monitor_.silent(now_ns_), TestResult::kPassed);
  EXPECT_EQ(monitor_.rate_reduced(now_ns_), TestResult::kPassed);
  EXPECT_EQ(monitor_.rate_too_high(now_ns_), TestResult::kPassed);
  EXPECT_EQ(monitor_.delayed(now_ns_), TestResult::kPassed);
  EXPECT_NEAR(monitor_.rate_hz(now_ns_), 20.0, 0.6);
  EXPECT_EQ(flips_, 1) << "from no result to passed";
}

TEST_F(DeliveryMonitorTest, WithoutAScanItIsSilentAfterTheDeadline) {
  EXPECT_EQ(monitor_.silent(kStart_ns + 200'000'000), TestResult::kNone);
  EXPECT_EQ(monitor_.silent(kStart_ns + 300'000'000), TestResult::kFailed);
  EXPECT_EQ(monitor_.rate_reduced(kStart_ns + 300'000'000), TestResult::kNone);
}

TEST_F(DeliveryMonitorTest, ARadarThatLoses80PercentIsReducedAndNotTimeAndAgainSilent) {
  run(5.0);
  run(5.0, 0.2);
  EXPECT_EQ(monitor_.rate_reduced(now_ns_), TestResult::kFailed);
  flips_ = 0;
  silent_s_ = 0.0;
  for (int i = 0; i < 60; ++i) {
    run(1.0, 0.2);
    EXPECT_EQ(monitor_.rate_reduced(now_ns_), TestResult::kFailed) << "after " << i << " s";
  }
  EXPECT_LE(flips_, 4) << "in a minute, by chance";
  EXPECT_LT(silent_s_, 1.5);
}

TEST_F(DeliveryMonitorTest, AnIntermittentRadarThatFallsSilentIsSilentInTheEnd) {
  run(5.0);
  run(20.0, 0.2);
  run(4.0, 0.0);
  EXPECT_EQ(monitor_.silent(now_ns_), TestResult::kFailed);
}

TEST_F(DeliveryMonitorTest, ASinglePauseIsNoReducedRate) {
  run(5.0);
  run(1.0, 0.0);
  EXPECT_EQ(monitor_.silent(now_ns_), TestResult::kFailed);
  for (int i = 0; i < 50; ++i) {
    run(0.1);
    EXPECT_NE(monitor_.rate_reduced(now_ns_), TestResult::kFailed);
  }
}

TEST_F(DeliveryMonitorTest, AfterASilenceItIsNotSoundBeforeItsRateIsKnown) {
  run(5.0);
  run(1.0, 0.0);
  ASSERT_EQ(monitor_.silent(now_ns_), TestResult::kFailed);
  for (int i = 0; i < 12; ++i) {  // every fourth scan arrives, without a pause beyond the deadline
    run(0.05, 1.0);
    if (i < 3) {
      EXPECT_EQ(monitor_.silent(now_ns_), TestResult::kNone) << "the rate is not known yet";
    }
    run(0.15, 0.0);
  }
  EXPECT_EQ(monitor_.silent(now_ns_), TestResult::kPassed);
  EXPECT_EQ(monitor_.rate_reduced(now_ns_), TestResult::kFailed);
}

TEST_F(DeliveryMonitorTest, TwiceTheRateIsTooHigh) {
  run(5.0);
  run(3.0, 1.0, 2);
  EXPECT_EQ(monitor_.rate_too_high(now_ns_), TestResult::kFailed);
}

TEST_F(DeliveryMonitorTest, ScansBeyondTheLatencyBudgetAreDelayedAndThoseOfUnknownAgeAreNotJudged) {
  run(3.0, 1.0, 1, -1);
  EXPECT_EQ(monitor_.delayed(now_ns_), TestResult::kNone);
  run(3.0, 1.0, 1, 140'000'000);
  EXPECT_EQ(monitor_.delayed(now_ns_), TestResult::kPassed);
  run(3.0, 1.0, 1, 160'000'000);
  EXPECT_EQ(monitor_.delayed(now_ns_), TestResult::kFailed);
}

}  // namespace
}  // namespace boresight::health
