#include "services/common/runtime/stop_signal.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <system_error>

namespace boresight::runtime {

namespace {

/// Any thread may handle the signal, also one of the middleware, so a sig_atomic_t is not enough.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "required in a signal handler");

/// Sends SIGKILL when it expires. Set before `has_stop_limit`, and never again.
timer_t stop_timer;
itimerspec stop_limit{};
std::atomic<bool> has_stop_limit{false};

void on_stop_signal(int number) {
  const bool is_first = received_signal.exchange(number) == 0;
  if (is_first && has_stop_limit) timer_settime(stop_timer, 0, &stop_limit, nullptr);
}

}  // namespace

void install_stop_signals() {
  struct sigaction action {};
  action.sa_handler = on_stop_signal;
  sigemptyset(&action.sa_mask);
  // Without SA_RESTART, so that a waiting system call returns and the loop sees the flag at once.
  action.sa_flags = 0;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

void limit_stop_time(std::chrono::milliseconds limit) {
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGKILL;
  if (timer_create(CLOCK_MONOTONIC, &event, &stop_timer) != 0) {
    throw std::system_error(errno, std::generic_category(), "timer_create");
  }
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(limit);
  stop_limit.it_value = {.tv_sec = seconds.count(), .tv_nsec = std::chrono::nanoseconds(limit - seconds).count()};
  has_stop_limit = true;
  if (stop_signalled()) timer_settime(stop_timer, 0, &stop_limit, nullptr);
}

bool stop_signalled() {
  return received_signal != 0;
}

int stop_signal() {
  return received_signal;
}

}  // namespace boresight::runtime
