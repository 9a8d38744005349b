// Histogram of durations with a constant ratio of bucket edges: percentiles of a whole run from a few hundred numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace boresight {

class LatencyHistogram {
 public:
  static constexpr std::size_t kBucketsPerDecade = 20;
  static constexpr std::size_t kBuckets = 6 * kBucketsPerDecade;  ///< 1 µs to 1 s

  void add(std::int64_t duration_ns) {
    const double us = std::max(1.0, static_cast<double>(duration_ns) * 1e-3);
    const auto index = static_cast<std::size_t>(std::log10(us) * static_cast<double>(kBucketsPerDecade));
    ++counts_[std::min(index, kBuckets - 1)];
    ++total_;
    max_us_ = std::max(max_us_, us);
  }

  /// Lower edge of a bucket.
  [[nodiscard]] static double edge_us(std::size_t bucket) {
    return std::pow(10.0, static_cast<double>(bucket) / static_cast<double>(kBucketsPerDecade));
  }
  /// The quantile `share` (0…1), at the geometric middle of its bucket (within 6 %), at most the maximum; 0 without
  /// data.
  [[nodiscard]] double percentile_us(double share) const {
    if (total_ == 0) return 0.0;
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total_)));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      seen += counts_[i];
      if (seen >= std::max<std::uint64_t>(wanted, 1)) return std::min(max_us_, std::sqrt(edge_us(i) * edge_us(i + 1)));
    }
    return max_us_;
  }
  [[nodiscard]] double max_us() const { return max_us_; }
  [[nodiscard]] std::uint64_t total() const { return total_; }
  [[nodiscard]] const std::array<std::uint64_t, kBuckets>& counts() const { return counts_; }

  /// Sets one bucket, for reading a record.
  void restore(std::size_t bucket, std::uint64_t count) {
    if (bucket >= kBuckets) return;
    total_ += count - counts_[bucket];
    counts_[bucket] = count;
  }
  void restore_max(double max_us) { max_us_ = max_us; }
  /// Adds another run's durations.
  void merge(const LatencyHistogram& other) {
    for (std::size_t i = 0; i < kBuckets; ++i) counts_[i] += other.counts_[i];
    total_ += other.total_;
    max_us_ = std::max(max_us_, other.max_us_);
  }

 private:
  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t total_ = 0;
  double max_us_ = 0.0;
};

}  // namespace boresight
