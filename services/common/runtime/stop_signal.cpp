#include "services/common/runtime/stop_signal.hpp"

#include <csignal>

namespace boresight::runtime {

namespace {

volatile std::sig_atomic_t stop_flag = 0;

void on_stop_signal(int) {
  stop_flag = 1;
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
  return stop_flag != 0;
}

}  // namespace boresight::runtime
