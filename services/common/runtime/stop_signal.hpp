// SIGTERM and SIGINT as a flag: a process that dies inside publish() leaves a mutex in shared memory locked for ever,
// so it may end only between two publications.
#pragma once

namespace boresight::runtime {

/// Installs the handlers; also ignores SIGPIPE.
void install_stop_signals();
[[nodiscard]] bool stop_signalled();

}  // namespace boresight::runtime
