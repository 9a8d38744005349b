// SIGTERM and SIGINT as a flag. A process that dies inside publish() leaves a mutex in shared memory locked, so it must
// end only between two publications.
#pragma once

namespace boresight::runtime {

/// Installs the handlers; also ignores SIGPIPE.
void install_stop_signals();
[[nodiscard]] bool stop_signalled();
/// The number of the last signal, 0 before the first.
[[nodiscard]] int stop_signal();

}  // namespace boresight::runtime
