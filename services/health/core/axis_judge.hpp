// Whether a mounting angle is beyond its tolerance: by confidence, debounced, with hysteresis.
// Equations: docs/algorithms/downstream.md (D2)(D3).
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "interfaces/messages/health_report.hpp"
#include "services/health/core/config.hpp"

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
    if (beyond_ ? !clearly_within : !clearly_beyond) {
      since_ns_ = kNever;
      return;
    }
    // Without this a clock that jumped back would delay the verdict by the size of the jump.
    if (since_ns_ == kNever || time_ns < since_ns_) since_ns_ = time_ns;
    const double needed_s = beyond_ ? config_.clear_s : config_.set_s;
    if (static_cast<double>(time_ns - since_ns_) * 1e-9 < needed_s) return;
    beyond_ = !beyond_;
    since_ns_ = kNever;
  }

  /// Withdraws the verdict and forgets the estimate: what it was made from is not to be believed.
  void clear() { *this = AxisJudge(config_, tolerance_rad_); }

  [[nodiscard]] bool is_observable() const { return observable_; }
  [[nodiscard]] bool is_beyond() const { return beyond_; }
  /// Beyond tolerance, and so far that the data are not usable.
  [[nodiscard]] bool is_inhibited() const { return beyond_ && std::abs(error_rad_) > config_.inhibit_rad; }
  [[nodiscard]] AxisHealth health() const {
    return {.error_rad = static_cast<float>(error_rad_),
            .std_rad = static_cast<float>(std_rad_),
            .tolerance_rad = static_cast<float>(tolerance_rad_),
            .observable = observable_ ? std::uint8_t{1} : std::uint8_t{0},
            .beyond_tolerance = beyond_ ? std::uint8_t{1} : std::uint8_t{0},
            .about_vehicle_axis = 0,
            .reserved = 0};
  }

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  Config config_;
  double tolerance_rad_ = 0.0;
  double error_rad_ = 0.0;
  double std_rad_ = 0.0;
  bool observable_ = false;
  bool beyond_ = false;
  std::int64_t since_ns_ = kNever;  // first estimate that contradicts the present verdict
};

}  // namespace boresight::health
