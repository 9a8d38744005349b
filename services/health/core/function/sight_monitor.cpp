#include "services/health/core/function/sight_monitor.hpp"

#include <algorithm>

namespace boresight::health {

SightMonitor::SightMonitor(const SightConfig& config)
    : config_(config),
      count_{.level = LearntLevel(config.least_log_count_std)},
      range_{.level = LearntLevel(config.least_log_range_std)} {}

void SightMonitor::smooth(Quantity& quantity, double value, double share) const {
  quantity.smoothed += share * (value - quantity.smoothed);
}

void SightMonitor::observe(const SeenScan& seen, double speed_mps, std::int64_t time_ns) {
  is_moving_ = std::abs(speed_mps) >= config_.least_speed_mps;  // false without a known speed
  if (!is_moving_) {
    moved_s_ = 0.0;
    last_ns_ = kNever;
    return;
  }
  const bool is_first = last_ns_ == kNever || time_ns < last_ns_;
  // A pause counts as the smoothing time at most: more would give one scan the weight of many.
  const double dt_s = is_first ? 0.0 : std::min(static_cast<double>(time_ns - last_ns_) * 1e-9, config_.smoothing_s);
  last_ns_ = time_ns;
  moved_s_ = is_first ? 0.0 : moved_s_ + dt_s;
  const double share = is_first ? 1.0 : 1.0 - std::exp(-dt_s / config_.smoothing_s);
  smooth(count_, std::log1p(seen.detections), share);
  if (seen.detections > 0.0) smooth(range_, std::log(std::max(seen.range_m, 1.0)), share);
  // What is smoothed must have forgotten its first value. A level must not follow the loss that it is to show.
  const bool is_settled = moved_s_ >= config_.smoothing_s;
  if (!is_settled) return;
  const bool is_usual = !is_known() || reduced() == TestResult::kPassed;
  const double weight_s = dt_s * (is_usual ? 1.0 : config_.unusual_share);
  count_.level.learn(count_.smoothed, weight_s, config_.memory_s);
  range_.level.learn(range_.smoothed, weight_s, config_.memory_s);
}

TestResult SightMonitor::below(const Quantity& quantity, double ratio) const {
  const double deviation = quantity.level.deviation(quantity.smoothed);
  const double limit = std::min(std::log(ratio), -config_.sigma * quantity.level.std());
  if (deviation < limit) return TestResult::kFailed;
  return deviation > config_.passing_share * limit ? TestResult::kPassed : TestResult::kNone;
}

TestResult SightMonitor::below(double ratio) const {
  if (!is_moving_ || !is_known() || moved_s_ < config_.smoothing_s) return TestResult::kNone;
  const TestResult count = below(count_, ratio), range = below(range_, ratio);
  if (count == TestResult::kFailed || range == TestResult::kFailed) return TestResult::kFailed;
  return count == TestResult::kPassed && range == TestResult::kPassed ? TestResult::kPassed : TestResult::kNone;
}

}  // namespace boresight::health
