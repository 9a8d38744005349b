#include "deploy/broker/judgement/progress_limits.hpp"

#include <charconv>
#include <stdexcept>
#include <string>
#include <string_view>

namespace boresight::broker {

namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;
constexpr std::int64_t kLeast_ms = 100;  // RouDi's threads wake that often
constexpr std::int64_t kMost_ms = 3'600'000;

void read(const Environment& environment, const char* name, std::int64_t& limit_ns) {
  const char* const value = environment(name);
  if (value == nullptr) return;
  const std::string_view text = value;
  std::int64_t limit_ms = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), limit_ms);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || limit_ms < kLeast_ms || limit_ms > kMost_ms) {
    throw std::invalid_argument(std::string(name) + "=" + value + ": must be a whole number from " +
                                std::to_string(kLeast_ms) + " to " + std::to_string(kMost_ms));
  }
  limit_ns = limit_ms * kNsPerMs;
}

}  // namespace

ProgressLimits limits_of(const Environment& environment) {
  ProgressLimits limits;
  read(environment, "BORESIGHT_ROUDI_ASLEEP_LIMIT_MS", limits.asleep_ns);
  read(environment, "BORESIGHT_ROUDI_STARVED_LIMIT_MS", limits.starved_ns);
  read(environment, "BORESIGHT_ROUDI_BUSY_LIMIT_MS", limits.busy_ns);
  return limits;
}

}  // namespace boresight::broker
