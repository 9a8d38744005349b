#include "services/health/core/faults/status.hpp"

#include <gtest/gtest.h>

#include "services/health/core/faults/debounce.hpp"

namespace boresight::health {
namespace {

using namespace dtc_status;
constexpr CycleConfig kTwoOfEach{.confirmation_cycles = 2, .healing_cycles = 2, .ageing_cycles = 3};
constexpr std::int64_t kMillisecond_ns = 1'000'000;

TEST(EventStatus, BeginsAsNotTested) {
  const EventStatus status;
  EXPECT_EQ(status.bits, 0x50);
  EXPECT_FALSE(status.is_stored());
}

TEST(EventStatus, AFailureIsPendingAndConfirmedAfterItsCycles) {
  EventStatus status;
  EXPECT_TRUE(status.take(TestResult::kFailed, kTwoOfEach));
  EXPECT_EQ(status.bits, kTestFailed | kTestFailedThisOperationCycle | kPending | kTestFailedSinceLastClear);
  EXPECT_FALSE(status.take(TestResult::kFailed, kTwoOfEach)) << "no new occurrence while it is failed";
  EXPECT_FALSE(status.has(kConfirmed)) << "a second failure in the same cycle does not confirm";
  EXPECT_FALSE(status.take(TestResult::kPassed, kTwoOfEach));
  EXPECT_TRUE(status.take(TestResult::kFailed, kTwoOfEach));
  EXPECT_EQ(status.occurrences, 2);
  EXPECT_FALSE(status.begin_cycle(kTwoOfEach));
  EXPECT_TRUE(status.has(kTestFailed)) << "the last known result stands over the cycle";
  EXPECT_TRUE(status.has(kTestNotCompletedThisOperationCycle));
  EXPECT_FALSE(status.has(kTestFailedThisOperationCycle));
  status.take(TestResult::kFailed, kTwoOfEach);
  EXPECT_TRUE(status.has(kConfirmed));
  EXPECT_TRUE(status.has(kWarningIndicatorRequested));
}

TEST(EventStatus, HealsAndAgesOverPassedCyclesOnly) {
  EventStatus status;
  for (int cycle = 0; cycle < 2; ++cycle) {
    status.take(TestResult::kFailed, kTwoOfEach);
    status.begin_cycle(kTwoOfEach);
  }
  ASSERT_TRUE(status.has(kConfirmed));
  for (int cycle = 0; cycle < 5; ++cycle) EXPECT_FALSE(status.begin_cycle(kTwoOfEach));
  EXPECT_TRUE(status.has(kConfirmed) && status.has(kPending)) << "a cycle without a test is no passed cycle";
  status.take(TestResult::kPassed, kTwoOfEach);
  EXPECT_FALSE(status.begin_cycle(kTwoOfEach));
  EXPECT_FALSE(status.has(kPending));
  EXPECT_TRUE(status.has(kWarningIndicatorRequested));
  status.take(TestResult::kPassed, kTwoOfEach);
  EXPECT_FALSE(status.begin_cycle(kTwoOfEach));
  EXPECT_FALSE(status.has(kWarningIndicatorRequested)) << "healed after two passed cycles";
  EXPECT_TRUE(status.has(kConfirmed));
  status.take(TestResult::kPassed, kTwoOfEach);
  EXPECT_TRUE(status.begin_cycle(kTwoOfEach)) << "aged after three";
  EXPECT_FALSE(status.is_stored());
  EXPECT_EQ(status.occurrences, 0);
}

TEST(EventStatus, ANewFailureBeginsHealingAndAgeingAnew) {
  EventStatus status;
  for (int cycle = 0; cycle < 2; ++cycle) {
    status.take(TestResult::kFailed, kTwoOfEach);
    status.begin_cycle(kTwoOfEach);
  }
  for (int cycle = 0; cycle < 2; ++cycle) {
    status.take(TestResult::kPassed, kTwoOfEach);
    status.begin_cycle(kTwoOfEach);
  }
  ASSERT_EQ(status.aged_cycles, 2);
  status.take(TestResult::kFailed, kTwoOfEach);
  EXPECT_EQ(status.aged_cycles, 0);
  EXPECT_EQ(status.healed_cycles, 0);
}

TEST(EventStatus, AWithdrawnResultCountsNoMoreAndStaysInTheMemory) {
  EventStatus status;
  status.take(TestResult::kFailed, CycleConfig{});
  status.withdraw();
  EXPECT_EQ(status.last, TestResult::kNone);
  EXPECT_FALSE(status.has(kTestFailed));
  EXPECT_TRUE(status.has(kConfirmed));
}

TEST(EventStatus, CountersStopAtTheirLargestValue) {
  EventStatus status;
  for (int i = 0; i < 70'000; ++i) {
    status.take(TestResult::kFailed, CycleConfig{});
    status.take(TestResult::kPassed, CycleConfig{});
  }
  EXPECT_EQ(status.occurrences, 65'535);
}

TEST(Debounce, CountsAResultAfterItsTimeWithoutInterruption) {
  constexpr DebounceTimes kTimes{.set_s = 0.5, .clear_s = 1.0};
  Debounce debounce;
  EXPECT_EQ(debounce.update(TestResult::kFailed, kTimes, 0), TestResult::kNone);
  EXPECT_EQ(debounce.update(TestResult::kFailed, kTimes, 250 * kMillisecond_ns), TestResult::kNone);
  EXPECT_NEAR(debounce.counter(), 63, 1);
  EXPECT_EQ(debounce.update(TestResult::kPassed, kTimes, 400 * kMillisecond_ns), TestResult::kNone);
  EXPECT_EQ(debounce.update(TestResult::kFailed, kTimes, 500 * kMillisecond_ns), TestResult::kNone);
  EXPECT_EQ(debounce.update(TestResult::kFailed, kTimes, 1000 * kMillisecond_ns), TestResult::kFailed);
  EXPECT_EQ(debounce.counter(), 127);
  EXPECT_EQ(debounce.update(TestResult::kPassed, kTimes, 1100 * kMillisecond_ns), TestResult::kFailed);
  EXPECT_EQ(debounce.update(TestResult::kPassed, kTimes, 2000 * kMillisecond_ns), TestResult::kFailed);
  EXPECT_EQ(debounce.update(TestResult::kPassed, kTimes, 2100 * kMillisecond_ns), TestResult::kPassed);
  EXPECT_EQ(debounce.counter(), -128);
}

TEST(Debounce, NoResultAndAClockThatGoesBackBeginAnew) {
  constexpr DebounceTimes kTimes{.set_s = 1.0, .clear_s = 1.0};
  Debounce debounce;
  debounce.update(TestResult::kFailed, kTimes, 0);
  debounce.update(TestResult::kNone, kTimes, 900 * kMillisecond_ns);
  EXPECT_EQ(debounce.update(TestResult::kFailed, kTimes, 1000 * kMillisecond_ns), TestResult::kNone);
  EXPECT_EQ(debounce.update(TestResult::kFailed, kTimes, -5000 * kMillisecond_ns), TestResult::kNone);
  EXPECT_EQ(debounce.update(TestResult::kFailed, kTimes, -4000 * kMillisecond_ns), TestResult::kFailed);
}

}  // namespace
}  // namespace boresight::health
