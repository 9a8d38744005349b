// For what a sleeping thread of another process waits, as the kernel shows it.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <sys/types.h>

#include "deploy/broker/judgement/broker_progress.hpp"

namespace boresight::broker {

/// A thread that waits for a mutex of the GNU C library.
struct MutexWait {
  std::uint64_t address;  ///< of the mutex in the memory of the process
};

/// The wait in the text of /proc/PID/task/TID/syscall; nothing if the thread waits for something else, or runs. The
/// library waits for a contended mutex by FUTEX_WAIT for the value 2, for everything else with another operation.
[[nodiscard]] std::optional<MutexWait> parse_mutex_wait(std::string_view syscall);

/// For what a thread of the process `pid` waits, whose /proc/PID/task/TID/syscall is `syscall`. kUnknown if this
/// process may not look into that one. It may look into its own child with the same user.
[[nodiscard]] Wait wait_of(pid_t pid, std::string_view syscall);

}  // namespace boresight::broker
