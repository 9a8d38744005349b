// Moments of the residual over an exponential window: the key figures of Report A §8, with constant memory.
#pragma once

#include <algorithm>
#include <cmath>

#include "interfaces/messages/alignment_estimate.hpp"

namespace boresight::alignment {

class SceneStatistics {
 public:
  /// Fades what is known by the time that passed; `window_s` is the time constant.
  void fade(double elapsed_s, double window_s) {
    const double keep = std::exp(-elapsed_s / window_s);
    for (double* sum : {&inliers_, &near_, &all_, &r1_, &r2_, &r3_, &r4_, &u2_}) *sum *= keep;
  }
  /// One inlier's residual with and without correction, m/s.
  void add_inlier(double residual, double uncorrected) {
    const double square = residual * residual;
    inliers_ += 1.0;
    all_ += 1.0;
    r1_ += residual;
    r2_ += square;
    r3_ += square * residual;
    r4_ += square * square;
    u2_ += uncorrected * uncorrected;
  }
  /// `is_near`: beyond the gate, but within three times of it.
  void add_outlier(bool is_near) {
    all_ += 1.0;
    if (is_near) near_ += 1.0;
  }

  [[nodiscard]] double inlier_ratio() const { return all_ > 0.0 ? inliers_ / all_ : 0.0; }
  /// In the gate and near it.
  [[nodiscard]] double counted() const { return inliers_ + near_; }
  /// Whether the gate holds clearly more (five stds of the counts, and most of what it holds) than the neighbourhood,
  /// twice as wide, lets expect of a background.
  [[nodiscard]] bool stands_out() const {
    const double excess = inliers_ - 0.5 * near_;
    return excess > 0.5 * inliers_ && excess * excess > 25.0 * (inliers_ + 0.25 * near_);
  }

  /// Fills the statistical fields; leaves seconds and counts alone.
  void write(AlignmentKpis& kpis) const {
    kpis.residual_rmse_mps = kpis.uncorrected_residual_rmse_mps = 0.0F;
    kpis.residual_skewness = kpis.residual_kurtosis = 0.0F;
    kpis.inlier_ratio = all_ > 0.0 ? static_cast<float>(inliers_ / all_) : 0.0F;
    if (inliers_ < 1.0) return;
    kpis.residual_rmse_mps = static_cast<float>(std::sqrt(r2_ / inliers_));
    kpis.uncorrected_residual_rmse_mps = static_cast<float>(std::sqrt(u2_ / inliers_));
    const double m = r1_ / inliers_, m2 = r2_ / inliers_, m3 = r3_ / inliers_, m4 = r4_ / inliers_;
    const double variance = m2 - m * m;
    if (variance < 1e-12) return;
    kpis.residual_skewness = static_cast<float>((m3 - 3.0 * m * m2 + 2.0 * m * m * m) / std::pow(variance, 1.5));
    kpis.residual_kurtosis =
        static_cast<float>((m4 - 4.0 * m * m3 + 6.0 * m * m * m2 - 3.0 * m * m * m * m) / (variance * variance));
  }

 private:
  double inliers_ = 0.0, near_ = 0.0, all_ = 0.0;
  double r1_ = 0.0, r2_ = 0.0, r3_ = 0.0, r4_ = 0.0, u2_ = 0.0;
};

}  // namespace boresight::alignment
