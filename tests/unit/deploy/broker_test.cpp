// Whether RouDi hangs, judged from what the kernel reports of its threads.
#include <csignal>
#include <map>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "deploy/broker/judgement/broker_progress.hpp"
#include "deploy/broker/judgement/mutex_wait.hpp"
#include "deploy/broker/judgement/progress_limits.hpp"
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
  watch(ProgressLimits{}.asleep_ns - kObservationPeriod_ns, [](int) {});
  EXPECT_EQ(progress_.hung(), std::nullopt);
  watch(kObservationPeriod_ns, [](int) {});
  EXPECT_THAT(progress_.hung().value_or(""), ::testing::HasSubstr("waits for a mutex, or sleeps, since 0.5 s"));
}

TEST_F(BrokerProgressTest, ThreadInAMutexOfAnEndedProcessIsHungAfterTheSameLimit) {
  watch_at_work(kSecond_ns);
  message_.wait = Wait::kMutexOfTheDead;
  watch(ProgressLimits{}.asleep_ns, [](int) {});
  EXPECT_THAT(progress_.hung().value_or(""), ::testing::HasSubstr("waits for a mutex of an ended process since 0.5 s"));
}

TEST_F(BrokerProgressTest, ThreadInAMutexOfALivingProcessMayBeStarvedUntilTheLongerLimit) {
  watch_at_work(kSecond_ns);
  message_.wait = discovery_.wait = Wait::kMutexOfAnother;
  watch(ProgressLimits{}.starved_ns - kObservationPeriod_ns, [](int) {});
  EXPECT_EQ(progress_.hung(), std::nullopt);
  watch(kObservationPeriod_ns, [](int) {});
  EXPECT_THAT(progress_.hung().value_or(""), ::testing::HasSubstr("waits for a mutex of a living process since 2.5 s"));
}

TEST_F(BrokerProgressTest, EndOfTheOwnerOfAMutexCountsAtOnce) {
  watch_at_work(kSecond_ns);
  message_.wait = discovery_.wait = Wait::kMutexOfAnother;
  watch(kSecond_ns, [](int) {});
  EXPECT_EQ(progress_.hung(), std::nullopt);
  message_.wait = Wait::kMutexOfTheDead;
  watch(kObservationPeriod_ns, [](int) {});
  EXPECT_NE(progress_.hung(), std::nullopt);
}

TEST_F(BrokerProgressTest, ThreadThatOversleepsItsTimerIsNotHungBeforeTheLongerLimit) {
  watch_at_work(kSecond_ns);
  message_.wait = discovery_.wait = Wait::kOther;
  watch(ProgressLimits{}.starved_ns - kObservationPeriod_ns, [](int) {});
  EXPECT_EQ(progress_.hung(), std::nullopt);
  watch(kObservationPeriod_ns, [](int) {});
  EXPECT_THAT(progress_.hung().value_or(""), ::testing::HasSubstr(" sleeps since 2.5 s"));
}

TEST_F(BrokerProgressTest, OneThreadInADeadMutexIsEnough) {
  watch_at_work(kSecond_ns);
  watch(kSecond_ns, [this](int) { ++message_.voluntary_switches; });
  EXPECT_THAT(progress_.hung().value_or(""), ::testing::HasSubstr(kDiscoveryThread));
}

TEST_F(BrokerProgressTest, StoppedRoudiIsHung) {
  watch_at_work(kSecond_ns);
  for (ThreadActivity* thread : {&other_, &message_, &discovery_}) thread->state = ThreadState::kStopped;
  message_.wait = Wait::kMutexOfAnother;  // at the moment of the stop
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
  watch(ProgressLimits{}.busy_ns + 2 * kObservationPeriod_ns, [this](int turn) {
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

TEST_F(BrokerProgressTest, SaysWhetherTheKernelShowsForWhatAThreadWaits) {
  watch_at_work(kSecond_ns);
  EXPECT_FALSE(progress_.sees_waits());
  message_.wait = discovery_.wait = Wait::kOther;
  watch_at_work(kSecond_ns);
  EXPECT_TRUE(progress_.sees_waits());
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

/// A mutex that processes share.
class SharedMutex {
 public:
  SharedMutex()
      : mutex_(static_cast<pthread_mutex_t*>(
            mmap(nullptr, sizeof(pthread_mutex_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    pthread_mutexattr_t kind;
    pthread_mutexattr_init(&kind);
    pthread_mutexattr_setpshared(&kind, PTHREAD_PROCESS_SHARED);
    pthread_mutexattr_settype(&kind, PTHREAD_MUTEX_RECURSIVE);  // as iceoryx's
    pthread_mutex_init(mutex_, &kind);
  }
  ~SharedMutex() { munmap(mutex_, sizeof(pthread_mutex_t)); }
  SharedMutex(const SharedMutex&) = delete;
  SharedMutex& operator=(const SharedMutex&) = delete;
  void lock() { pthread_mutex_lock(mutex_); }
  /// Locked by another, and somebody waits: true within five seconds.
  [[nodiscard]] bool is_waited_for() const {
    const volatile int* const word = &mutex_->__data.__lock;
    for (int i = 0; i < 500 && *word != 2; ++i) usleep(10'000);
    return *word == 2;
  }

 private:
  pthread_mutex_t* mutex_;
};

/// Forks, calls `work` in the child, which then sleeps until it is killed.
template <typename Work>
pid_t forked(const Work& work) {
  const pid_t child = fork();
  if (child != 0) return child;
  work();
  for (;;) pause();
}

void end(pid_t child) {
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

/// What the only thread of a child waits for, once the kernel shows it asleep.
Wait wait_of_child(pid_t child) {
  for (int i = 0; i < 500; ++i) {
    const std::vector<ThreadActivity> threads = read_activity(child);
    if (threads.size() == 1 && threads[0].state == ThreadState::kSleeping) return threads[0].wait;
    usleep(10'000);
  }
  return Wait::kUnknown;
}

TEST(ThreadActivityWait, IsForAMutexWhoseOwnerLivesAndThenHasEnded) {
  SharedMutex mutex;
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t owner = forked([&] {
    mutex.lock();
    static_cast<void>(!write(pipe_ends[1], "x", 1));
  });
  char locked = 0;
  ASSERT_EQ(read(pipe_ends[0], &locked, 1), 1);
  const pid_t waiting = forked([&] { mutex.lock(); });
  EXPECT_TRUE(mutex.is_waited_for());
  EXPECT_EQ(wait_of_child(waiting), Wait::kMutexOfAnother);
  end(owner);
  EXPECT_EQ(wait_of_child(waiting), Wait::kMutexOfTheDead);
  end(waiting);
  for (const int descriptor : pipe_ends) close(descriptor);
}

TEST(ThreadActivityWait, OfAThreadThatPausesIsForSomethingElse) {
  const pid_t child = forked([] {});
  EXPECT_EQ(wait_of_child(child), Wait::kOther);
  end(child);
}

TEST(MutexWaitText, IsAWaitOfTheLibraryForAContendedMutexOnly) {
  const std::string futex = std::to_string(SYS_futex);
  const auto shared = parse_mutex_wait(futex + " 0x7fff10 0x0 0x2 0x0 0x0 0x0 0x7ffc 0x7f00\n");
  ASSERT_TRUE(shared);
  EXPECT_EQ(shared->address, 0x7fff10U);
  EXPECT_TRUE(parse_mutex_wait(futex + " 0x7fff10 0x80 0x2 0x0")) << "private to the process";
  EXPECT_FALSE(parse_mutex_wait(futex + " 0x7fff10 0x189 0x0 0x7ffc"))
      << "a semaphore or a condition with a time limit";
  EXPECT_FALSE(parse_mutex_wait("1 0x7fff10 0x0 0x2 0x0")) << "another call";
  EXPECT_FALSE(parse_mutex_wait("running\n"));
  EXPECT_FALSE(parse_mutex_wait(""));
}

TEST(ProgressLimitsText, IsReadFromTheEnvironment) {
  const std::map<std::string, const char*> variables = {{"BORESIGHT_ROUDI_ASLEEP_LIMIT_MS", "800"},
                                                        {"BORESIGHT_ROUDI_STARVED_LIMIT_MS", "9000"}};
  const ProgressLimits limits = limits_of([&](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second;
  });
  EXPECT_EQ(limits.asleep_ns, 800'000'000);
  EXPECT_EQ(limits.starved_ns, 9'000'000'000);
  EXPECT_EQ(limits.busy_ns, ProgressLimits{}.busy_ns);
  for (const char* const wrong : {"", "99", "3600001", "1 s", "0.5", "-1"}) {
    EXPECT_THROW(static_cast<void>(limits_of([wrong](const char*) { return wrong; })), std::invalid_argument) << wrong;
  }
}

}  // namespace
}  // namespace boresight::broker
