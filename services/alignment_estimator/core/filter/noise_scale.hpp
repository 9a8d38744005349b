// Ratio of a radar's real noise to the stated noise, learnt from its residuals.
#pragma once

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/filter/scan_sums.hpp"

namespace boresight::alignment {

/// Factors of the variances of range rates and of angles, by Fisher scoring on sliding sums of squared residuals. The
/// two can be separated because the angles' share of a residual grows with speed and angle.
class NoiseScale {
 public:
  void add(const ScanSums& sums, double keep) {
    score_rate_ = keep * score_rate_ + sums.noise_score_rate;
    score_angle_ = keep * score_angle_ + sums.noise_score_angle;
    rate_rate_ = keep * rate_rate_ + sums.noise_rate_rate;
    rate_angle_ = keep * rate_angle_ + sums.noise_rate_angle;
    angle_angle_ = keep * angle_angle_ + sums.noise_angle_angle;
    // Weight of the stated noise, in detections.
    constexpr double kPrior = 100.0;
    constexpr double kRate = 0.1;
    const double a = rate_rate_ + kPrior, b = rate_angle_, c = angle_angle_ + kPrior;
    const double determinant = a * c - b * b;
    if (!(determinant > 0.0) || !std::isfinite(determinant)) return;
    const double step_rate = std::clamp(kRate * (c * score_rate_ - b * score_angle_) / determinant, -0.1, 0.1);
    const double step_angle = std::clamp(kRate * (a * score_angle_ - b * score_rate_) / determinant, -0.1, 0.1);
    score_rate_ -= rate_rate_ * step_rate + rate_angle_ * step_angle;
    score_angle_ -= rate_angle_ * step_rate + angle_angle_ * step_angle;
    log_rate_ = std::clamp(log_rate_ + step_rate, -2.5, 2.5);
    log_angle_ = std::clamp(log_angle_ + step_angle, -2.5, 2.5);
  }
  [[nodiscard]] double rate_variance_factor() const { return std::exp(log_rate_); }
  [[nodiscard]] double angle_variance_factor() const { return std::exp(log_angle_); }
  [[nodiscard]] double log_angle_variance_factor() const { return log_angle_; }
  /// Variance of the logarithm above, by the Fisher information of the sums without the part that noise of the range
  /// rates explains too.
  [[nodiscard]] double log_angle_variance(double prior_variance) const {
    const double information = angle_angle_ - rate_angle_ * rate_angle_ / (rate_rate_ + 1.0);
    return 1.0 / (1.0 / prior_variance + 0.5 * std::max(information, 0.0));
  }
  /// Starts from factors on the stated stds; one that is not positive and finite is ignored.
  void set_scales(double rate_scale, double angle_scale) {
    const auto set = [](double scale, double& log_factor) {
      if (scale > 0.0 && std::isfinite(scale)) log_factor = std::clamp(2.0 * std::log(scale), -2.5, 2.5);
    };
    set(rate_scale, log_rate_);
    set(angle_scale, log_angle_);
  }

 private:
  double log_rate_ = 0.0, log_angle_ = 0.0;
  double score_rate_ = 0.0, score_angle_ = 0.0;
  double rate_rate_ = 0.0, rate_angle_ = 0.0, angle_angle_ = 0.0;
};

}  // namespace boresight::alignment
