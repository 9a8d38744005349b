// Section 5: the stationary world.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>

#include "tests/benchmarks/realism/common/neighbours.hpp"
#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

class StationaryWorld {
 public:
  static constexpr std::size_t kRanges = 10;  // rings of 10 m

  void add(const ObservedScan& scan);
  void end_drive() { earlier_.clear(); }
  void merge(const StationaryWorld& other);

  [[nodiscard]] const Samples& per_scan(Facing facing) const { return per_scan_[static_cast<std::size_t>(facing)]; }
  /// Of all detections of a scan, whatever they are.
  [[nodiscard]] const Samples& all_per_scan() const { return all_per_scan_; }
  /// Share of the ranges from ring `from` to ring `to`, both included.
  [[nodiscard]] double percent_of_rings(std::size_t from, std::size_t to) const;
  [[nodiscard]] const Samples& rcs_dbsm() const { return rcs_dbsm_; }
  /// Distance to the nearest other one of the scan; detections with at least two others within 1 m.
  [[nodiscard]] const Samples& nearest_m() const { return nearest_m_; }
  [[nodiscard]] double percent_with_two_near() const { return two_near_.percent(); }
  /// Another one within 0.5 m in the next scan, in the next scan turned about the sensor, and 13 scans later.
  [[nodiscard]] double seen_again() const { return again_.value(); }
  [[nodiscard]] double seen_again_by_chance() const { return chance_.value(); }
  [[nodiscard]] double seen_later() const { return later_.value(); }
  /// Robust standard deviation of the range rate about a stationary reflector's, by strength: below −10, −10 … 0,
  /// 0 … 10, above 10 dBsm.
  static constexpr std::size_t kLevels = 4;
  [[nodiscard]] double rate_std_mps(std::size_t level) const { return deviation_mps_[level].robust_std(); }
  /// Kurtosis (3 for a normal distribution) and 95 % quantile of the absolute value, at all strengths.
  [[nodiscard]] double rate_kurtosis() const;
  [[nodiscard]] double rate_p95_mps() const;

 private:
  std::array<Samples, 3> per_scan_;  // by facing
  Samples all_per_scan_;
  std::array<std::size_t, kRanges> rings_{};
  Samples rcs_dbsm_, nearest_m_;
  std::array<Samples, kLevels> deviation_mps_;
  Share two_near_, again_, chance_, later_;
  std::map<std::uint32_t, std::deque<Places>> earlier_;  // by radar
};

}  // namespace boresight::bench::realism
