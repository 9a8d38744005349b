#include "services/alignment_estimator/core/kpi/residual_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::alignment {

namespace {

std::size_t bin_of(double residual_mps) {
  constexpr double kLast = static_cast<double>(ResidualStatistics::kBins) - 1.0;
  const double place = 0.5 * (residual_mps / ResidualStatistics::kRange_mps + 1.0) * (kLast + 1.0);
  return static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, kLast));
}

}  // namespace

void ResidualStatistics::fade(double elapsed_s, double window_s) {
  const double keep = std::exp(-elapsed_s / window_s);
  for (double* sum : {&inliers_, &all_, &r1_, &r2_, &r3_, &r4_, &u2_}) *sum *= keep;
  for (double& count : after_) count *= keep;
  for (double& count : before_) count *= keep;
}

void ResidualStatistics::add_inlier(double residual_mps, double uncorrected_mps) {
  const double square = residual_mps * residual_mps;
  inliers_ += 1.0;
  all_ += 1.0;
  r1_ += residual_mps;
  r2_ += square;
  r3_ += square * residual_mps;
  r4_ += square * square;
  u2_ += uncorrected_mps * uncorrected_mps;
  after_[bin_of(residual_mps)] += 1.0;
  before_[bin_of(uncorrected_mps)] += 1.0;
}

void ResidualStatistics::write(AlignmentKpis& kpis) const {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  kpis.residual_rmse_mps = kpis.uncorrected_residual_rmse_mps = kUnknown;
  kpis.residual_skewness = kpis.residual_kurtosis = kUnknown;
  kpis.inlier_ratio = all_ > 0.0 ? static_cast<float>(inliers_ / all_) : kUnknown;
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

}  // namespace boresight::alignment
