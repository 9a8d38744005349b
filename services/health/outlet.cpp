#include "services/health/outlet.hpp"

#include <exception>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"

namespace boresight::health {

namespace {
constexpr std::int64_t kRetryPeriod_ns = 5'000'000'000;
}

void Outlet::write(const HealthReport& report, bool at_once, std::int64_t now_ns) {
  if (!config_.enabled || (!at_once && now_ns < next_ns_)) return;
  next_ns_ = now_ns + static_cast<std::int64_t>(config_.period_s * 1e9);
  if (!writer_ && now_ns >= retry_ns_) open(now_ns);
  if (writer_ && !writer_->write(report, runtime::realtime_now_ns())) {
    node_.fault(Fault::kLink, "DDS: the middleware rejected a sample");
  }
}

void Outlet::open(std::int64_t now_ns) {
  try {
    writer_.emplace(config_, vehicle_);
    runtime::log::info("diagnostics are sent on DDS domain {}", config_.domain);
  } catch (const std::exception& error) {
    node_.fault(Fault::kLink, error.what());
    retry_ns_ = now_ns + kRetryPeriod_ns;
  }
}

}  // namespace boresight::health
