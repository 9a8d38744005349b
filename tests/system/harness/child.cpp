#include "tests/system/harness/child.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "services/common/runtime/clock.hpp"

namespace boresight::harness {

namespace {

constexpr int kExpectationFailed = 99;
constexpr int kThrew = 98;

}  // namespace

Child::Child(const std::function<int()>& body) {
  std::fflush(nullptr);
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ > 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  int code = kThrew;
  try {
    code = body();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "child: %s\n", error.what());
  }
  // exit(), not _exit(): leaving the middleware happens in its static objects' destructors.
  std::exit(testing::Test::HasFailure() ? kExpectationFailed : code);
}

Child::~Child() {
  if (result_) return;
  send(SIGKILL);
  static_cast<void>(wait_for(5.0));
}

void Child::send(int signal) const {
  if (!result_) kill(pid_, signal);
}

std::optional<int> Child::wait_for(double seconds) {
  static_cast<void>(eventually(seconds, [this] {
    if (result_) return true;
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
    result_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return true;
  }));
  return result_;
}

std::optional<int> Child::stop(double seconds) {
  send(SIGTERM);
  return wait_for(seconds);
}

void* allocate_shared(std::size_t bytes) {
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  return memory;
}

void free_shared(void* memory, std::size_t bytes) {
  munmap(memory, bytes);
}

bool eventually(double seconds, const std::function<bool()>& condition) {
  const std::int64_t deadline_ns = runtime::monotonic_now_ns() + static_cast<std::int64_t>(seconds * 1e9);
  while (!condition()) {
    if (runtime::monotonic_now_ns() > deadline_ns) return false;
    sleep_s(0.005);
  }
  return true;
}

void sleep_s(double seconds) {
  const auto whole = static_cast<time_t>(seconds);
  timespec rest{.tv_sec = whole, .tv_nsec = static_cast<long>((seconds - static_cast<double>(whole)) * 1e9)};
  while (nanosleep(&rest, &rest) != 0) {
  }
}

}  // namespace boresight::harness
