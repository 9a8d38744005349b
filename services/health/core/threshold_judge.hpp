// Whether an error is beyond a threshold: by probability, debounced, with hysteresis.
// Equations: docs/algorithms/downstream.md (D2)(D3)(D4).
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "services/health/core/config.hpp"
#include "services/health/core/faults/debounce.hpp"

namespace boresight::health {

/// Probability that the true error is beyond ±`threshold` (D2), for a Gaussian estimate `error` with the standard
/// deviation `std`; all of one unit. With `std` = 0 the estimate is the true error; an infinite threshold is never
/// exceeded.
[[nodiscard]] inline double exceedance_probability(double error, double std, double threshold) {
  const double size = std::abs(error);
  if (!(std > 0.0)) return size > threshold ? 1.0 : 0.0;
  const auto normal = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
  return normal((size - threshold) / std) + normal((-size - threshold) / std);
}

class ThresholdJudge {
 public:
  ThresholdJudge() = default;
  /// `threshold_rad` may be infinite: then there is no verdict.
  ThresholdJudge(const Config& config, double threshold_rad) : config_(config), threshold_rad_(threshold_rad) {}

  /// One estimate at `time_ns` (its measurement time); finite, `std_rad` not negative. An estimate that is neither
  /// clearly beyond nor clearly within restarts both times.
  void update(double error_rad, double std_rad, std::int64_t time_ns) {
    const double doubt = 1.0 - config_.confidence;
    const double probability = exceedance_probability(error_rad, std_rad, threshold_rad_);
    const bool is_clearly_beyond = probability > config_.confidence;
    const bool is_clearly_within =
        exceedance_probability(error_rad, std_rad, config_.clear_ratio * threshold_rad_) < doubt;
    // A first verdict of within needs an estimate that can tell: an error of zero would be within with confidence.
    // After a verdict of beyond, also of an earlier process, only an error that is clearly within passes.
    const bool can_tell = exceedance_probability(0.0, std_rad, threshold_rad_) < doubt;
    const bool is_within = std::abs(error_rad) <= threshold_rad_ && can_tell && !is_clearly_beyond;
    const bool needs_clarity = is_beyond() || was_beyond_;
    const bool passes = std::isfinite(threshold_rad_) && (needs_clarity ? is_clearly_within : is_within);
    const TestResult raw = is_clearly_beyond ? TestResult::kFailed : passes ? TestResult::kPassed : TestResult::kNone;
    verdict_ = debounce_.update(raw, {.set_s = config_.set_s, .clear_s = config_.clear_s}, time_ns);
    if (verdict_ != TestResult::kNone) was_beyond_ = false;
  }

  /// Withdraws the verdict.
  void clear() { *this = ThresholdJudge(config_, threshold_rad_); }
  /// The last known verdict, of an earlier process, is beyond.
  void restore_beyond() { was_beyond_ = true; }

  [[nodiscard]] double threshold_rad() const { return threshold_rad_; }
  /// kPassed within the threshold, kFailed beyond it; kNone until the estimates have determined it.
  [[nodiscard]] TestResult verdict() const { return verdict_; }
  [[nodiscard]] bool is_beyond() const { return verdict_ == TestResult::kFailed; }

 private:
  Config config_;
  double threshold_rad_ = 0.0;
  bool was_beyond_ = false;  // in an earlier process, and not judged yet in this one
  TestResult verdict_ = TestResult::kNone;
  Debounce debounce_;
};

}  // namespace boresight::health
