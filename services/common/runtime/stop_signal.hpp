// SIGTERM and SIGINT as a flag, and the time that a process has to end. A process that dies inside publish() leaves a
// mutex in shared memory locked, so it must end only between two publications.
#pragma once

#include <chrono>

namespace boresight::runtime {

/// Installs the handlers; also ignores SIGPIPE.
void install_stop_signals();
/// The first signal leaves this much time: then SIGKILL ends the process, also one that waits for a hung RouDi. Throws
/// std::system_error if the kernel has no timer for it.
void limit_stop_time(std::chrono::milliseconds limit);
[[nodiscard]] bool stop_signalled();
/// The number of the last signal, 0 before the first.
[[nodiscard]] int stop_signal();

}  // namespace boresight::runtime
