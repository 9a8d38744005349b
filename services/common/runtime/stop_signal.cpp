#include "services/common/runtime/stop_signal.hpp"

#include <atomic>
#include <csignal>

namespace boresight::runtime {

namespace {

/// Any thread may handle the signal, also one of the middleware, so a sig_atomic_t is not enough.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "required in a signal handler");

void on_stop_signal(int number) {
  received_signal = number;
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

bool stop_signalled() {
  return received_signal != 0;
}

int stop_signal() {
  return received_signal;
}

}  // namespace boresight::runtime
