// When the supervisor acts on a service. Pure: values and the time in, a verdict out.
#pragma once

#include <cstdint>

namespace boresight::supervisor {

enum class Verdict : std::uint8_t {
  kFine,
  kNotReady,  ///< started, but not READY within its limit
  kSilent,    ///< READY, but its last watchdog message is older than the limit
};

struct ServiceTimes {
  bool is_ready;
  std::int64_t started_ns;
  std::int64_t last_stroke_ns;  ///< last watchdog message; since READY, if none has come
};

[[nodiscard]] Verdict verdict_on(const ServiceTimes& times, std::int64_t ready_limit_ns, std::int64_t watchdog_limit_ns,
                                 std::int64_t now_ns);

/// Delay before a process is started again that failed `failures` times in a row: none the first time, then 0.25 s,
/// doubling up to 5 s.
[[nodiscard]] std::int64_t restart_delay_ns(std::uint32_t failures);

/// A service that refuses its configuration (exit code 2) while the domain runs is tried this often. A file that is
/// being written may be whole at the next try; after that, only another change of a file helps.
inline constexpr std::uint32_t kConfigurationTries = 3;

}  // namespace boresight::supervisor
