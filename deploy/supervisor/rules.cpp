#include "deploy/supervisor/rules.hpp"

#include <algorithm>

namespace boresight::supervisor {

Verdict verdict_on(const ServiceTimes& times, std::int64_t ready_limit_ns, std::int64_t watchdog_limit_ns,
                   std::int64_t now_ns) {
  if (!times.is_ready) return now_ns - times.started_ns > ready_limit_ns ? Verdict::kNotReady : Verdict::kFine;
  return now_ns - times.last_stroke_ns > watchdog_limit_ns ? Verdict::kSilent : Verdict::kFine;
}

std::int64_t restart_delay_ns(std::uint32_t failures) {
  constexpr std::int64_t kFirst_ns = 250'000'000;
  constexpr std::int64_t kLongest_ns = 5'000'000'000;
  if (failures <= 1) return 0;
  const std::uint32_t doublings = std::min(failures - 2, 8U);
  return std::min(kLongest_ns, kFirst_ns << doublings);
}

}  // namespace boresight::supervisor
