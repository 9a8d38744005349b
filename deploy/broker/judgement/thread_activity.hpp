// What the kernel reports of a process's threads.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "deploy/broker/judgement/broker_progress.hpp"

namespace boresight::broker {

/// The activity in the texts of /proc/PID/task/TID/status and .../schedstat; nothing if `status` is incomplete. Kernels
/// without scheduler statistics have no `schedstat`: an empty text is a processor time of 0.
[[nodiscard]] std::optional<ThreadActivity> parse_activity(std::string_view status, std::string_view schedstat);

/// All threads of the process, with what they wait for; a thread that ends meanwhile is not included. Empty if the
/// process is gone or hidden.
[[nodiscard]] std::vector<ThreadActivity> read_activity(pid_t pid);

}  // namespace boresight::broker
