// Moments and a histogram.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace boresight::bench {

/// Moments of range-rate residuals (m/s), with a histogram over ±kReach_mps.
class Moments {
 public:
  static constexpr double kReach_mps = 0.6;
  static constexpr std::size_t kBins = 120;

  void add(double x) {
    count_ += 1.0;
    s1_ += x;
    s2_ += x * x;
    s3_ += x * x * x;
    s4_ += x * x * x * x;
    const double place = (x + kReach_mps) / (2.0 * kReach_mps) * static_cast<double>(kBins);
    if (place >= 0.0 && place < static_cast<double>(kBins)) ++bins_[static_cast<std::size_t>(place)];
  }
  void add(const Moments& other) {
    count_ += other.count_;
    s1_ += other.s1_;
    s2_ += other.s2_;
    s3_ += other.s3_;
    s4_ += other.s4_;
    for (std::size_t b = 0; b < kBins; ++b) bins_[b] += other.bins_[b];
  }
  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] double rmse() const { return std::sqrt(s2_ / count_); }
  [[nodiscard]] double skewness() const {
    const double m = s1_ / count_, m2 = s2_ / count_, m3 = s3_ / count_;
    return (m3 - 3.0 * m * m2 + 2.0 * m * m * m) / std::pow(m2 - m * m, 1.5);
  }
  [[nodiscard]] double kurtosis() const {
    const double m = s1_ / count_, m2 = s2_ / count_, m3 = s3_ / count_, m4 = s4_ / count_, v = m2 - m * m;
    return (m4 - 4.0 * m * m3 + 6.0 * m * m * m2 - 3.0 * m * m * m * m) / (v * v);
  }
  [[nodiscard]] const std::array<std::uint64_t, kBins>& bins() const { return bins_; }

 private:
  double count_ = 0.0, s1_ = 0.0, s2_ = 0.0, s3_ = 0.0, s4_ = 0.0;
  std::array<std::uint64_t, kBins> bins_{};
};

}  // namespace boresight::bench
