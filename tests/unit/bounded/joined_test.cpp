// A middleware that does not return: the tool goes on and ends with its result.
#include "services/boresight/bounded/joined.hpp"

#include <atomic>
#include <cstdio>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace boresight::bounded {
namespace {

using namespace std::chrono_literals;

constexpr Limits kShort{.join = 100ms, .leave = 100ms};
constexpr auto kNever = [] { return false; };

[[noreturn]] void wait_for_ever() {
  for (;;) pause();
}

struct Orderly {
  explicit Orderly(std::atomic<int>& count) : members(count) { ++members; }
  ~Orderly() { --members; }
  Orderly(const Orderly&) = delete;
  Orderly& operator=(const Orderly&) = delete;
  std::atomic<int>& members;
};
struct NeverLeaves {
  ~NeverLeaves() { wait_for_ever(); }
};

/// Exit code of a child that calls `work`, or the negative number of the signal that ended it.
template <typename Work>
int exit_code_of(const Work& work) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    alarm(10);
    work();
    std::exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

// First: this process has not begun a step yet.
TEST(EndOfProcess, IsLeftToTheCallerWithoutSteps) {
  EXPECT_EQ(exit_code_of([] {
              end_process_of_steps(5);
              std::exit(6);
            }),
            6);
}

TEST(Joined, JoinsAndLeaves) {
  std::atomic<int> members = 0;
  {
    const Joined<Orderly> joined(
        "domain 7", [&] { return std::make_unique<Orderly>(members); }, kNever);
    EXPECT_EQ(joined->members, 1);
  }
  EXPECT_EQ(members, 0);
}

TEST(Joined, PassesOnWhyTheDomainCannotBeJoined) {
  const auto join = [] {
    const Joined<Orderly> joined(
        "domain 7", []() -> std::unique_ptr<Orderly> { throw std::invalid_argument("no interface"); }, kNever);
  };
  EXPECT_THROW(join(), std::invalid_argument);
}

TEST(Joined, GivesUpADomainThatIsNotJoinedInTime) {
  EXPECT_EQ(exit_code_of([] {
              try {
                const Joined<Orderly> joined("domain 7", []() -> std::unique_ptr<Orderly> { wait_for_ever(); }, kNever,
                                             {.join = 1'000ms, .leave = 100ms});
              } catch (const std::runtime_error& error) {
                end_process_of_steps(error.what() == std::string("domain 7 was not joined within 1 s") ? 3 : 99);
              }
            }),
            3);
}

TEST(Joined, IsCancelledByASignal) {
  EXPECT_EQ(exit_code_of([] {
              try {
                const Joined<Orderly> joined(
                    "domain 7", []() -> std::unique_ptr<Orderly> { wait_for_ever(); }, [] { return true; });
              } catch (const std::runtime_error&) {
                end_process_of_steps(130);
              }
            }),
            130);
}

TEST(Joined, EndsWithTheResultIfTheDomainIsNotLeft) {
  EXPECT_EQ(exit_code_of([] {
              {
                const Joined<NeverLeaves> joined(
                    "domain 7", [] { return std::make_unique<NeverLeaves>(); }, kNever, kShort);
              }
              end_process_of_steps(1);
            }),
            1);
}

}  // namespace
}  // namespace boresight::bounded
