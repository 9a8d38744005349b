#include "services/common/runtime/stop_signal.hpp"

#include <atomic>
#include <csignal>

namespace boresight::runtime {

namespace {

/// The signal may be handled on any thread, the middleware's included, so that a sig_atomic_t would not do.
std::atomic<bool> stop_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "or a handler may not touch it");

void on_stop_signal(int) {
  stop_flag = true;
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
  return stop_flag;
}

}  // namespace boresight::runtime
