// Moments and histograms of the range-rate residual over an exponential window: the key figures of Burza 2025, §8, with
// constant memory, whatever the method.
#pragma once

#include <array>
#include <cstddef>

#include "interfaces/messages/alignment_estimate.hpp"

namespace boresight::alignment {

class ResidualStatistics {
 public:
  /// Bins of equal width over ±kRange_mps; values beyond are in the first and the last bin.
  static constexpr std::size_t kBins = 81;
  static constexpr double kRange_mps = 1.0;
  using Histogram = std::array<double, kBins>;

  /// Decays the sums by the elapsed time; `window_s` is the time constant.
  void fade(double elapsed_s, double window_s);
  /// One inlier's residual (measured − predicted) with and without correction, m/s.
  void add_inlier(double residual_mps, double uncorrected_mps);
  void add_outlier() { all_ += 1.0; }

  /// Number of inliers in the window; it decays.
  [[nodiscard]] double inliers() const { return inliers_; }
  /// Counts of the inliers' residuals with and without correction; they decay.
  [[nodiscard]] const Histogram& after() const { return after_; }
  [[nodiscard]] const Histogram& before() const { return before_; }
  /// Centre of a bin, m/s.
  [[nodiscard]] static double bin_centre_mps(std::size_t bin) {
    return kRange_mps * (2.0 * (static_cast<double>(bin) + 0.5) / static_cast<double>(kBins) - 1.0);
  }

  /// Fills RMSE, skewness, kurtosis and inlier ratio (NaN without data); leaves the others alone.
  void write(AlignmentKpis& kpis) const;

 private:
  double inliers_ = 0.0, all_ = 0.0;
  double r1_ = 0.0, r2_ = 0.0, r3_ = 0.0, r4_ = 0.0, u2_ = 0.0;
  Histogram after_{}, before_{};
};

}  // namespace boresight::alignment
