// When RouDi counts as hung, and the keys of these limits in the environment.
#pragma once

#include <cstdint>
#include <functional>

namespace boresight::broker {

/// When RouDi counts as hung.
struct ProgressLimits {
  /// A periodic thread sleeps for this long in the mutex of an ended process, is stopped, or it cannot be known for
  /// what it waits. A choice: five missed wake-ups, since a domain restart takes about a second, and data must be back
  /// within two seconds.
  std::int64_t asleep_ns = 500'000'000;
  /// The same if a living process owns the mutex, or if the thread waits for its timer: on an overloaded machine both
  /// only lack a processor. A choice: by then the watchdog has ended a service that hangs, at the latest after 2 s, and
  /// its mutexes are those of an ended process.
  std::int64_t starved_ns = 2'500'000'000;
  /// A periodic thread uses this much processor time without a pause. A choice: the longest work, the registration of
  /// many processes at once, takes a tenth of it.
  std::int64_t busy_ns = 2'000'000'000;
};

/// Value of a variable of the environment; null without one.
using Environment = std::function<const char*(const char* name)>;

/// The limits with the values of BORESIGHT_ROUDI_ASLEEP_LIMIT_MS, …_STARVED_LIMIT_MS and …_BUSY_LIMIT_MS, where they
/// are set. Throws std::invalid_argument, with the variable's name, if one is no whole number from 100 to 3,600,000.
[[nodiscard]] ProgressLimits limits_of(const Environment& environment);

}  // namespace boresight::broker
