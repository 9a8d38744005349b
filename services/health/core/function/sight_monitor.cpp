#include "services/health/core/function/sight_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::health {

SightMonitor::SightMonitor(const SightConfig& config)
    : config_(config),
      count_{.level = LearntLevel(config.least_log_count_std)},
      range_{.level = LearntLevel(config.least_log_range_std)} {}

void SightMonitor::restore(const SightLevels& levels) {
  count_.level.restore(levels.log_count);
  range_.level.restore(levels.log_range);
}

bool SightMonitor::sees_nothing() const {
  return count_.smoothed <= std::log1p(config_.least_detections) || range_.smoothed < std::log(config_.least_range_m);
}

bool SightMonitor::has_few() const {
  return is_known() &&
         count_.level.deviation(std::log1p(config_.least_detections)) > -config_.sigma * count_.level.std();
}

void SightMonitor::observe(const SeenScan& seen, double speed_mps, std::int64_t time_ns) {
  is_moving_ = std::abs(speed_mps) >= config_.least_speed_mps;  // false without a known speed
  if (!is_moving_) {
    motion_.interrupt();
    return;
  }
  motion_.advance(time_ns, config_.smoothing_s);
  count_.smooth(std::log1p(seen.detections), motion_.share());
  if (seen.detections > 0.0) range_.smooth(std::log(std::max(seen.range_m, 1.0)), motion_.share());
  // What is smoothed must have forgotten its first value. A level must not follow the loss that it is to show.
  const bool is_settled = motion_.since_s() >= config_.smoothing_s;
  if (!is_settled) return;
  const bool sees = !sees_nothing() || has_few();
  saw_nothing_s_ = sees ? 0.0 : saw_nothing_s_ + motion_.dt_s();
  if (!seen.is_sound || !sees) return;
  const bool is_usual = !is_known() || reduced() == TestResult::kPassed;
  const double weight_s = motion_.dt_s() * (is_usual ? 1.0 : config_.unusual_share);
  count_.level.learn(count_.smoothed, weight_s, config_.memory_s);
  range_.level.learn(range_.smoothed, weight_s, config_.memory_s);
}

TestResult SightMonitor::below(const LevelledQuantity& quantity, double ratio) const {
  const double limit = std::min(std::log(ratio), -config_.sigma * quantity.level.std());
  return beyond(quantity.deviation(), limit, config_.passing_share);
}

TestResult SightMonitor::below(double ratio) const {
  if (!is_moving_ || !is_known() || motion_.since_s() < config_.smoothing_s) return TestResult::kNone;
  const TestResult count = below(count_, ratio), range = below(range_, ratio);
  if (count == TestResult::kFailed || range == TestResult::kFailed) return TestResult::kFailed;
  return count == TestResult::kPassed && range == TestResult::kPassed ? TestResult::kPassed : TestResult::kNone;
}

TestResult SightMonitor::blind() const {
  if (is_moving_ && saw_nothing_s_ >= config_.learning_s) return TestResult::kFailed;
  return below(config_.blind_ratio);
}

}  // namespace boresight::health
