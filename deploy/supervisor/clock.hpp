// The monotonic clock.
#pragma once

#include <cstdint>
#include <ctime>

namespace boresight::supervisor {

[[nodiscard]] inline std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

/// Returns earlier if a signal comes.
inline void sleep_ns(std::int64_t duration_ns) {
  const timespec duration{.tv_sec = duration_ns / 1'000'000'000, .tv_nsec = duration_ns % 1'000'000'000};
  nanosleep(&duration, nullptr);
}

}  // namespace boresight::supervisor
