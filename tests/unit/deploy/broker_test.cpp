// Whether RouDi hangs, judged from what the kernel reports of its threads.
#include <csignal>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "deploy/broker/judgement/broker_progress.hpp"
#include "deploy/broker/judgement/thread_activity.hpp"

namespace boresight::broker {
namespace {

/// RouDi's threads, observed once a period.
class BrokerProgressTest : public ::testing::Test {
 protected:
  /// Observes for `duration_ns`; between observations, `change` is called with the number of the observation.
  template <typename Change>
  void watch(std::int64_t duration_ns, Change change) {
    for (std::int64_t passed_ns = 0; passed_ns < duration_ns; passed_ns += kObservationPeriod_ns) {
      change(++turn_);
      time_ns_ += kObservationPeriod_ns;
      progress_.observe(time_ns_, {other_, message_, discovery_});
    }
  }
  /// Both periodic threads wake every second observation, that is every 100 ms.
  void work(int turn) {
    if (turn % 2 != 0) return;
    ++message_.voluntary_switches;
    ++discovery_.voluntary_switches;
  }
  void watch_at_work(std::int64_t duration_ns) {
    watch(duration_ns, [this](int turn) { work(turn); });
  }

  ThreadActivity other_{"iox-roudi", 7, 1000, ThreadState::kSleeping};
  ThreadActivity message_{kMessageThread, 100, 2000, ThreadState::kSleeping};
  ThreadActivity discovery_{kDiscoveryThread, 100, 3000, ThreadState::kSleeping};
  BrokerProgress progress_;
  std::int64_t time_ns_ = 0;
  int turn_ = 0;
};

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST_F(BrokerProgressTest, RoudiAtWorkIsNotHung) {
  watch_at_work(10 * kSecond_ns);
  EXPECT_TRUE(progress_.is_judgeable());
  EXPECT_EQ(progress_.hung(), std::nullopt);
}

TEST_F(BrokerProgressTest, BothThreadsInADeadMutexAreHungAfterTheLimit) {
  watch_at_work(kSecond_ns);
  watch(kAsleepLimit_ns - kObservationPeriod_ns, [](int) {});
  EXPECT_EQ(progress_.hung(), std::nullopt);
  watch(kObservationPeriod_ns, [](int) {});
  EXPECT_THAT(progress_.hung().value_or(""), ::testing::HasSubstr("waits for a mutex since 0.5 s"));
}

TEST_F(BrokerProgressTest, OneThreadInADeadMutexIsEnough) {
  watch_at_work(kSecond_ns);
  watch(kSecond_ns, [this](int) { ++message_.voluntary_switches; });
  EXPECT_THAT(progress_.hung().value_or(""), ::testing::HasSubstr(kDiscoveryThread));
}

TEST_F(BrokerProgressTest, StoppedRoudiIsHung) {
  watch_at_work(kSecond_ns);
  for (ThreadActivity* thread : {&other_, &message_, &discovery_}) thread->state = ThreadState::kStopped;
  watch(kSecond_ns, [](int) {});
  EXPECT_THAT(progress_.hung().value_or(""), ::testing::HasSubstr("is stopped since"));
}

TEST_F(BrokerProgressTest, ThreadsThatGetNoProcessorAreNotHung) {
  watch_at_work(kSecond_ns);
  message_.state = discovery_.state = ThreadState::kRunnable;
  watch(10 * kSecond_ns, [](int) {});
  EXPECT_EQ(progress_.hung(), std::nullopt);
}

TEST_F(BrokerProgressTest, ThreadThatWaitsForOneWithoutAProcessorIsNotHung) {
  watch_at_work(kSecond_ns);
  discovery_.state = ThreadState::kRunnable;  // it may hold the mutex
  watch(10 * kSecond_ns, [](int) {});
  EXPECT_EQ(progress_.hung(), std::nullopt);
}

TEST_F(BrokerProgressTest, ThreadThatWaitsForADiskIsNotHung) {
  watch_at_work(kSecond_ns);
  message_.state = ThreadState::kOnDisk;
  watch(10 * kSecond_ns, [](int) {});
  EXPECT_EQ(progress_.hung(), std::nullopt);
}

TEST_F(BrokerProgressTest, ThreadThatSpinsIsHung) {
  watch_at_work(kSecond_ns);
  message_.state = ThreadState::kRunnable;
  watch(kBusyLimit_ns + 2 * kObservationPeriod_ns, [this](int turn) {
    if (turn % 2 == 0) ++discovery_.voluntary_switches;
    message_.processor_time_ns += kObservationPeriod_ns;
  });
  EXPECT_THAT(progress_.hung().value_or(""), ::testing::HasSubstr("runs without a pause"));
}

TEST_F(BrokerProgressTest, TimeThatTheObserverMissedDoesNotCount) {
  watch_at_work(kSecond_ns);
  time_ns_ += 100 * kSecond_ns;
  progress_.observe(time_ns_, {other_, message_, discovery_});
  EXPECT_EQ(progress_.hung(), std::nullopt);
}

TEST_F(BrokerProgressTest, UnknownThreadsAreNotJudged) {
  message_.name = discovery_.name = "renamed";
  watch(10 * kSecond_ns, [](int) {});
  EXPECT_FALSE(progress_.is_judgeable());
  EXPECT_EQ(progress_.hung(), std::nullopt);
}

TEST(ThreadActivityText, IsReadFromTheKernelsFormat) {
  const auto activity = parse_activity(
      "Name:\tMon+Discover\nState:\tS (sleeping)\nTgid:\t5\nvoluntary_ctxt_switches:\t42\n"
      "nonvoluntary_ctxt_switches:\t7\n",
      "541469 102973 12\n");
  ASSERT_TRUE(activity);
  EXPECT_EQ(activity->name, kDiscoveryThread);
  EXPECT_EQ(activity->voluntary_switches, 42U);
  EXPECT_EQ(activity->processor_time_ns, 541469);
  EXPECT_EQ(activity->state, ThreadState::kSleeping);
  EXPECT_FALSE(parse_activity("Name:\tx\n", ""));
}

TEST(ThreadActivityText, OfAStoppedProcessIsStopped) {
  const pid_t child = fork();
  if (child == 0) {
    for (;;) pause();
  }
  kill(child, SIGSTOP);
  int status = 0;
  waitpid(child, &status, WUNTRACED);
  const std::vector<ThreadActivity> threads = read_activity(child);
  ASSERT_EQ(threads.size(), 1U);
  EXPECT_EQ(threads[0].state, ThreadState::kStopped);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(read_activity(child).empty());
}

}  // namespace
}  // namespace boresight::broker
