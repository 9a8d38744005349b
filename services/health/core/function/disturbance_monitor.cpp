#include "services/health/core/function/disturbance_monitor.hpp"

#include <cmath>

namespace boresight::health {

DisturbanceMonitor::DisturbanceMonitor(const DisturbanceConfig& config)
    : config_(config), unexplained_{.level = LearntLevel(config.least_log_std)} {}

void DisturbanceMonitor::observe(const ExplainedScan& scan, double speed_mps, std::int64_t time_ns) {
  time_.advance(time_ns, config_.smoothing_s);
  unexplained_.smooth(std::log1p(scan.unexplained), time_.share());
  detections_ += time_.share() * (std::log1p(scan.detections) - detections_);
  // What is smoothed must have forgotten its first value. A level must not follow what it is to show.
  const bool is_settled = time_.since_s() >= config_.smoothing_s;
  const bool is_moving = std::abs(speed_mps) >= config_.least_speed_mps;
  if (!is_settled || !is_moving) return;
  const bool is_usual = !is_known() || disturbed() == TestResult::kPassed;
  unexplained_.level.learn(unexplained_.smoothed, time_.dt_s() * (is_usual ? 1.0 : config_.unusual_share),
                           config_.memory_s);
}

double DisturbanceMonitor::share() const {
  const double all = std::expm1(detections_);
  return all > 0.0 ? std::expm1(unexplained_.smoothed) / all : 0.0;
}

TestResult DisturbanceMonitor::disturbed() const {
  if (!is_known() || time_.since_s() < config_.smoothing_s) return TestResult::kNone;
  const TestResult number =
      beyond(unexplained_.deviation(), config_.sigma * unexplained_.level.std(), config_.passing_share);
  const TestResult part = beyond(share(), config_.least_share, config_.passing_share);
  if (number == TestResult::kFailed && part == TestResult::kFailed) return TestResult::kFailed;
  return number == TestResult::kPassed || part == TestResult::kPassed ? TestResult::kPassed : TestResult::kNone;
}

}  // namespace boresight::health
