// Ends the wait of an event loop at a time of the monotonic clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include <iceoryx_posh/popo/user_trigger.hpp>
#include <iceoryx_posh/popo/wait_set.hpp>

namespace boresight::runtime {

/// The middleware's timed wait ends at a time of the wall clock: if that clock is set back by an hour, the wait lasts
/// an hour longer. A loop therefore waits without a limit, and this thread ends the wait.
///
/// The thread blocks all signals, so that the main thread gets them. Its lock is private to the process, and the
/// semaphore in shared memory needs none: a process that is killed meanwhile leaves no lock behind.
class WaitTimer {
 public:
  /// `waitset` must outlive it. Throws std::runtime_error if the system has no timer, and std::system_error if it has
  /// no thread left.
  explicit WaitTimer(iox::popo::WaitSet<>& waitset);
  ~WaitTimer();
  WaitTimer(const WaitTimer&) = delete;
  WaitTimer& operator=(const WaitTimer&) = delete;

  /// A wait that begins now ends at `time_ns` of the monotonic clock, or earlier. Allocates nothing. A call of the
  /// system is needed only if no earlier end is set.
  void end_wait_at(std::int64_t time_ns, std::int64_t now_ns);

 private:
  void run();

  iox::popo::UserTrigger trigger_;
  int timer_ = -1;
  std::int64_t set_ns_ = 0;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace boresight::runtime
