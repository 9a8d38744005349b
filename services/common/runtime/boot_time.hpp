// How long a service was away: the time between two of its processes, also across suspension, whatever the wall clock
// does.
#pragma once

#include <cstdint>

namespace boresight::runtime {

/// A moment of one boot of the machine.
struct BootTime {
  std::uint64_t boot = 0;          ///< fingerprint of the kernel's boot id; 0: not known
  std::int64_t since_boot_ns = 0;  ///< since_boot_ns() of clock.hpp
};

/// Reads a file.
[[nodiscard]] std::uint64_t boot_fingerprint();
/// Seconds from `then` to `now`; infinite if the machine was booted in between, or if one of them is not known or not
/// in this order.
[[nodiscard]] double seconds_between(const BootTime& then, const BootTime& now);

}  // namespace boresight::runtime
