#include "services/health/core/function/delivery_monitor.hpp"

namespace boresight::health {

namespace {
TestResult result_of(bool is_failed) {
  return is_failed ? TestResult::kFailed : TestResult::kPassed;
}
constexpr std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e9);
}
}  // namespace

DeliveryMonitor::DeliveryMonitor(const DeliveryConfig& config, double expected_rate_hz, double deadline_s,
                                 double latency_s, double window_s, std::int64_t start_ns)
    : config_(config),
      expected_rate_hz_(expected_rate_hz),
      deadline_ns_(nanoseconds(deadline_s)),
      silence_limit_ns_(deadline_ns_),
      budget_ns_(nanoseconds(config.latency_budget_s + latency_s)),
      start_ns_(start_ns),
      rate_(std::max(window_s, config.judged_scans / expected_rate_hz)),
      arrivals_(config.pauses_window_s),
      pauses_(config.pauses_window_s),
      dated_(window_s),
      delayed_(window_s) {}

void DeliveryMonitor::observe(std::int64_t age_ns, std::int64_t now_ns) {
  if (scans_ > 0 && !delivers(now_ns)) {
    // The rate begins anew after a silence. Otherwise it would stay low for a window after a single pause.
    rate_.clear();
    pauses_.add(now_ns);
  }
  ++scans_;
  last_ns_ = now_ns;
  rate_.add(now_ns);
  arrivals_.add(now_ns);
  silence_limit_ns_ = silence_limit_ns(now_ns);
  if (age_ns < 0) return;
  dated_.add(now_ns);
  if (age_ns > budget_ns_) delayed_.add(now_ns);
}

std::int64_t DeliveryMonitor::silence_limit_ns(std::int64_t now_ns) {
  const std::uint64_t arrivals = arrivals_.sum(now_ns);
  if (!is_intermittent(now_ns) || arrivals == 0) return deadline_ns_;
  // Scans that arrive by chance with a mean interval: a pause of n intervals has the probability e^-n.
  const double interval_s = config_.pauses_window_s / static_cast<double>(arrivals);
  return std::max(deadline_ns_, nanoseconds(config_.silence_scans * interval_s));
}

TestResult DeliveryMonitor::silent(std::int64_t now_ns) {
  if (scans_ == 0) return now_ns - start_ns_ > deadline_ns_ ? TestResult::kFailed : TestResult::kNone;
  if (now_ns - last_ns_ > silence_limit_ns_) return TestResult::kFailed;
  return is_rate_known(now_ns) || is_intermittent(now_ns) ? TestResult::kPassed : TestResult::kNone;
}

TestResult DeliveryMonitor::rate_reduced(std::int64_t now_ns) {
  if (is_intermittent(now_ns)) return TestResult::kFailed;
  if (!delivers(now_ns) || !is_rate_known(now_ns)) return TestResult::kNone;
  return result_of(rate_.rate_hz(now_ns) < config_.min_rate_ratio * expected_rate_hz_);
}

TestResult DeliveryMonitor::rate_too_high(std::int64_t now_ns) {
  if (!delivers(now_ns) || !rate_.is_full(now_ns)) return TestResult::kNone;
  return result_of(rate_.rate_hz(now_ns) > config_.max_rate_ratio * expected_rate_hz_);
}

TestResult DeliveryMonitor::delayed(std::int64_t now_ns) {
  const std::uint64_t dated = dated_.sum(now_ns);
  if (dated == 0) return TestResult::kNone;
  return result_of(static_cast<double>(delayed_.sum(now_ns)) > config_.max_delayed_ratio * static_cast<double>(dated));
}

double DeliveryMonitor::last_seen_s(std::int64_t now_ns) const {
  return scans_ == 0 ? -1.0 : static_cast<double>(now_ns - last_ns_) * 1e-9;
}

}  // namespace boresight::health
