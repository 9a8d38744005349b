// The clock of the ECU's data path. Cores never include this header: they get time as an argument.
#pragma once

#include <cstdint>

namespace boresight::runtime {

/// CLOCK_MONOTONIC in nanoseconds, the base of all stamps in messages.
[[nodiscard]] std::int64_t monotonic_now_ns();
/// CLOCK_BOOTTIME in nanoseconds: time since the machine was booted, also while it was suspended.
[[nodiscard]] std::int64_t since_boot_ns();
/// CLOCK_REALTIME in nanoseconds since the epoch, for readers off the ECU and for sensor stamps.
[[nodiscard]] std::int64_t realtime_now_ns();
/// CPU time of the calling thread in nanoseconds.
[[nodiscard]] std::int64_t thread_cpu_time_ns();

}  // namespace boresight::runtime
