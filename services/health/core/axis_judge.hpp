// Whether a mounting angle is beyond its tolerance: by confidence, debounced, with hysteresis.
// Equations: docs/algorithms/downstream.md (D2)(D3).
#pragma once

#include <cmath>
#include <cstdint>

#include "interfaces/messages/health_report.hpp"
#include "services/health/core/config.hpp"
#include "services/health/core/faults/debounce.hpp"

namespace boresight::health {

class AxisJudge {
 public:
  AxisJudge() = default;
  AxisJudge(const Config& config, double tolerance_rad) : config_(config), tolerance_rad_(tolerance_rad) {}

  /// One estimate of the axis at `time_ns` (its measurement time). An estimate that is not observable or not finite
  /// changes no verdict. An estimate that is neither clearly beyond nor clearly within restarts both times.
  void update(double error_rad, double std_rad, bool observable, std::int64_t time_ns) {
    observable_ = observable && std::isfinite(error_rad) && std::isfinite(std_rad) && std_rad >= 0.0;
    if (!observable_) return;
    error_rad_ = error_rad;
    std_rad_ = std_rad;
    const double margin = config_.confidence_sigma * std_rad;
    const bool clearly_beyond = std::abs(error_rad) - margin > tolerance_rad_;
    const bool clearly_within = std::abs(error_rad) + margin < config_.clear_ratio * tolerance_rad_;
    // A first verdict of within needs an estimate that can tell: its margin is smaller than the tolerance. After a
    // verdict of beyond, also of an earlier process, only an axis that is clearly within passes.
    const bool is_within = std::abs(error_rad) <= tolerance_rad_ && margin < tolerance_rad_;
    const bool needs_clarity = is_beyond() || was_beyond_;
    const bool passes =
        std::isfinite(tolerance_rad_) && (needs_clarity ? clearly_within : is_within && !clearly_beyond);
    const TestResult raw = clearly_beyond ? TestResult::kFailed : passes ? TestResult::kPassed : TestResult::kNone;
    verdict_ = debounce_.update(raw, {.set_s = config_.set_s, .clear_s = config_.clear_s}, time_ns);
    if (verdict_ != TestResult::kNone) was_beyond_ = false;
  }

  /// Withdraws the verdict and forgets the estimate: what it was made from is not to be believed.
  void clear() { *this = AxisJudge(config_, tolerance_rad_); }
  /// The last known verdict, of an earlier process, is that the axis is beyond its tolerance.
  void restore_beyond() { was_beyond_ = true; }

  [[nodiscard]] bool is_observable() const { return observable_; }
  /// Whether the axis is within its tolerance; kNone until the estimates have determined it.
  [[nodiscard]] TestResult verdict() const { return verdict_; }
  [[nodiscard]] bool is_beyond() const { return verdict_ == TestResult::kFailed; }
  /// Beyond tolerance, and so far that the data are not usable.
  [[nodiscard]] bool is_inhibited() const { return is_beyond() && std::abs(error_rad_) > config_.inhibit_rad; }
  [[nodiscard]] AxisHealth health() const {
    return {.error_rad = static_cast<float>(error_rad_),
            .std_rad = static_cast<float>(std_rad_),
            .tolerance_rad = static_cast<float>(tolerance_rad_),
            .limit_rad = 0.0F,
            .beyond_tolerance_probability = 0.0F,
            .beyond_limit_probability = 0.0F,
            .observable = observable_ ? std::uint8_t{1} : std::uint8_t{0},
            .beyond_tolerance = is_beyond() ? std::uint8_t{1} : std::uint8_t{0},
            .about_vehicle_axis = 0,
            .effect = AxisEffect::kUnknown};
  }

 private:
  Config config_;
  double tolerance_rad_ = 0.0;
  double error_rad_ = 0.0;
  double std_rad_ = 0.0;
  bool observable_ = false;
  bool was_beyond_ = false;  // in an earlier process, and not judged yet in this one
  TestResult verdict_ = TestResult::kNone;
  Debounce debounce_;
};

}  // namespace boresight::health
