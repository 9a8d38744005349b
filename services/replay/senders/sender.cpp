#include "services/replay/senders/sender.hpp"

#include <ctime>

#include "services/common/runtime/stop_signal.hpp"

namespace boresight::replay {

void Sender::wait_until(std::int64_t due_ns) {
  const timespec due{.tv_sec = due_ns / 1'000'000'000, .tv_nsec = due_ns % 1'000'000'000};
  while (!runtime::stop_signalled() && clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) != 0) {
  }
}

}  // namespace boresight::replay
