// What the error of a mounting angle does to the use of the data: it is compensated, reduces them, or forbids their
// use.
#pragma once

#include <cmath>
#include <cstdint>

#include "interfaces/messages/health_report.hpp"
#include "services/health/core/config.hpp"
#include "services/health/core/threshold_judge.hpp"

namespace boresight::health {

/// The effect by the latest known results against tolerance and limit of use.
[[nodiscard]] inline AxisEffect effect_of(TestResult tolerance, TestResult limit) {
  if (limit == TestResult::kFailed) return AxisEffect::kNotAvailable;
  if (tolerance == TestResult::kFailed) return AxisEffect::kReduced;
  return tolerance == TestResult::kPassed ? AxisEffect::kCompensated : AxisEffect::kUnknown;
}

/// Writes the probabilities that belong to the error and the standard deviation of `axis`.
inline void set_probabilities(AxisHealth& axis) {
  const auto beyond = [&axis](float threshold_rad) {
    return static_cast<float>(exceedance_probability(axis.error_rad, axis.std_rad, threshold_rad));
  };
  axis.beyond_tolerance_probability = beyond(axis.tolerance_rad);
  axis.beyond_limit_probability = beyond(axis.limit_rad);
}

class AxisJudge {
 public:
  AxisJudge() = default;
  AxisJudge(const Config& config, double tolerance_rad, double limit_rad)
      : tolerance_(config, tolerance_rad), limit_(config, limit_rad) {}

  /// One estimate of the axis at `time_ns` (its measurement time). An estimate that is not observable or not finite
  /// changes no verdict.
  void update(double error_rad, double std_rad, bool observable, std::int64_t time_ns) {
    observable_ = observable && std::isfinite(error_rad) && std::isfinite(std_rad) && std_rad >= 0.0;
    if (!observable_) return;
    error_rad_ = error_rad;
    std_rad_ = std_rad;
    tolerance_.update(error_rad, std_rad, time_ns);
    limit_.update(error_rad, std_rad, time_ns);
  }

  /// Withdraws the verdicts and forgets the estimate: what it was made from is not to be believed.
  void clear() {
    tolerance_.clear();
    limit_.clear();
    error_rad_ = std_rad_ = 0.0;
    observable_ = false;
  }
  /// The last known verdict, of an earlier process, is that the axis is beyond its tolerance, or its limit.
  void restore_beyond_tolerance() { tolerance_.restore_beyond(); }
  void restore_beyond_limit() { limit_.restore_beyond(); }

  [[nodiscard]] bool is_observable() const { return observable_; }
  [[nodiscard]] const ThresholdJudge& tolerance() const { return tolerance_; }
  [[nodiscard]] const ThresholdJudge& limit() const { return limit_; }
  [[nodiscard]] AxisHealth health() const {
    AxisHealth health{.error_rad = static_cast<float>(error_rad_),
                      .std_rad = static_cast<float>(std_rad_),
                      .tolerance_rad = static_cast<float>(tolerance_.threshold_rad()),
                      .limit_rad = static_cast<float>(limit_.threshold_rad()),
                      .beyond_tolerance_probability = 0.0F,
                      .beyond_limit_probability = 0.0F,
                      .observable = observable_ ? std::uint8_t{1} : std::uint8_t{0},
                      .beyond_tolerance = tolerance_.is_beyond() ? std::uint8_t{1} : std::uint8_t{0},
                      .about_vehicle_axis = 0,
                      .effect = effect_of(tolerance_.verdict(), limit_.verdict())};
    set_probabilities(health);
    return health;
  }

 private:
  ThresholdJudge tolerance_;
  ThresholdJudge limit_;
  double error_rad_ = 0.0;
  double std_rad_ = 0.0;
  bool observable_ = false;
};

/// One angle about the sensor's own axis and about the vehicle's axis. Either may be observable without the other.
struct AngleJudge {
  AxisJudge sensor;
  AxisJudge vehicle;

  /// The verdict on the angle by those on both axes: beyond if either is, within if either is.
  [[nodiscard]] TestResult tolerance() const {
    return combined(sensor.tolerance().verdict(), vehicle.tolerance().verdict());
  }
  [[nodiscard]] TestResult limit() const { return combined(sensor.limit().verdict(), vehicle.limit().verdict()); }
  /// The axis that the verdict is about, with the angle's effect.
  [[nodiscard]] AxisHealth health() const {
    const bool is_about_sensor =
        sensor.limit().is_beyond() ||
        (!vehicle.limit().is_beyond() &&
         (sensor.tolerance().is_beyond() || (!vehicle.tolerance().is_beyond() && sensor.is_observable()))) ||
        !vehicle.is_observable();
    AxisHealth health = is_about_sensor ? sensor.health() : vehicle.health();
    health.about_vehicle_axis = is_about_sensor ? 0 : 1;
    health.effect = effect_of(tolerance(), limit());
    return health;
  }
  void clear() {
    sensor.clear();
    vehicle.clear();
  }
  void restore(bool beyond_tolerance, bool beyond_limit) {
    for (AxisJudge* axis : {&sensor, &vehicle}) {
      if (beyond_tolerance) axis->restore_beyond_tolerance();
      if (beyond_limit) axis->restore_beyond_limit();
    }
  }

 private:
  [[nodiscard]] static TestResult combined(TestResult a, TestResult b) {
    if (a == TestResult::kFailed || b == TestResult::kFailed) return TestResult::kFailed;
    return a == TestResult::kPassed || b == TestResult::kPassed ? TestResult::kPassed : TestResult::kNone;
  }
};

}  // namespace boresight::health
