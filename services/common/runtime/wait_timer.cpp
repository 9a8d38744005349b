#include "services/common/runtime/wait_timer.hpp"

#include <algorithm>
#include <csignal>
#include <stdexcept>

#include <pthread.h>
#include <sys/timerfd.h>
#include <unistd.h>

namespace boresight::runtime {

WaitTimer::WaitTimer(iox::popo::WaitSet<>& waitset) : timer_(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC)) {
  if (timer_ < 0) throw std::runtime_error("the system has no timer left");
  waitset.attachEvent(trigger_).or_else([](auto) { throw std::logic_error("too many inputs for one node"); });
  sigset_t all{};
  sigset_t before{};
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

WaitTimer::~WaitTimer() {
  ending_ = true;
  end_wait_at(1, 0);
  thread_.join();
  close(timer_);
}

void WaitTimer::end_wait_at(std::int64_t time_ns, std::int64_t now_ns) {
  if (now_ns < set_ns_ && set_ns_ <= time_ns) return;
  set_ns_ = std::max<std::int64_t>(time_ns, 1);  // zero would switch the timer off
  const itimerspec end{.it_interval = {},
                       .it_value = {.tv_sec = set_ns_ / 1'000'000'000, .tv_nsec = set_ns_ % 1'000'000'000}};
  timerfd_settime(timer_, TFD_TIMER_ABSTIME, &end, nullptr);
}

void WaitTimer::run() {
  pthread_setname_np(pthread_self(), "wait timer");
  std::uint64_t expirations = 0;
  while (!ending_) {
    if (read(timer_, &expirations, sizeof(expirations)) == sizeof(expirations)) trigger_.trigger();
  }
}

}  // namespace boresight::runtime
