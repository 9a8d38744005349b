// Times of samples as people read them.
#pragma once

#include <cstdint>
#include <ctime>
#include <string>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace boresight::diagnostics_text {

/// "12:34:56.7", local time, of a time since the epoch.
[[nodiscard]] inline std::string shown_time(std::int64_t time_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  constexpr std::int64_t kTenth_ns = 100'000'000;
  // Of a damaged sample: the division rounds towards zero, and a negative rest has no digit.
  const std::int64_t time_not_negative_ns = time_ns < 0 ? 0 : time_ns;
  return fmt::format("{:%H:%M:%S}.{}", fmt::localtime(static_cast<std::time_t>(time_not_negative_ns / kSecond_ns)),
                     time_not_negative_ns % kSecond_ns / kTenth_ns);
}

}  // namespace boresight::diagnostics_text
