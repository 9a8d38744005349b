// Learns on line what is usual for a radar: the level of a quantity of its scans, with its spread.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "services/health/core/faults/status.hpp"

namespace boresight::health {

/// A level as it is kept over a restart.
struct StoredLevel {
  double mean = 0.0;
  double variance = 0.0;
  double learnt_s = 0.0;  ///< time over which it was learnt
};

/// Level of one quantity: the mean and the variance of its smoothed value, learnt with a fading memory.
class LearntLevel {
 public:
  LearntLevel() = default;
  explicit LearntLevel(double least_std) : learnt_{.variance = least_std * least_std}, least_std_(least_std) {}

  /// `value` over the last `dt_s`; a level forgets over `memory_s`.
  void learn(double value, double dt_s, double memory_s) {
    if (dt_s <= 0.0) return;
    learnt_.learnt_s = std::min(learnt_.learnt_s + dt_s, memory_s);
    const double error = value - learnt_.mean;
    const double share = dt_s / learnt_.learnt_s;
    learnt_.mean += share * error;
    learnt_.variance += share * (error * error - learnt_.variance);
  }
  [[nodiscard]] double deviation(double value) const { return value - learnt_.mean; }
  [[nodiscard]] double std() const { return std::max(least_std_, std::sqrt(learnt_.variance)); }
  [[nodiscard]] double learnt_s() const { return learnt_.learnt_s; }

  [[nodiscard]] const StoredLevel& stored() const { return learnt_; }
  void restore(const StoredLevel& stored) { learnt_ = stored; }

 private:
  StoredLevel learnt_;
  double least_std_ = 0.0;
};

/// A quantity of the scans, smoothed, and its level.
struct LevelledQuantity {
  LearntLevel level;
  double smoothed = 0.0;

  void smooth(double value, double share) { smoothed += share * (value - smoothed); }
  [[nodiscard]] double deviation() const { return level.deviation(smoothed); }
};

/// Result of a test that fails at `limit` in the direction of its sign, and passes within `passing_share` of it.
[[nodiscard]] inline TestResult beyond(double deviation, double limit, double passing_share) {
  const double ratio = deviation / limit;
  if (ratio > 1.0) return TestResult::kFailed;
  return ratio < passing_share ? TestResult::kPassed : TestResult::kNone;
}

/// Time from scan to scan, as long as a condition holds without interruption.
class ScanTime {
 public:
  /// A scan at `time_ns`. A pause counts as the smoothing time at most: more would give one scan the weight of many.
  void advance(std::int64_t time_ns, double smoothing_s) {
    const bool is_first = last_ns_ == kNever || time_ns < last_ns_;
    dt_s_ = is_first ? 0.0 : std::min(static_cast<double>(time_ns - last_ns_) * 1e-9, smoothing_s);
    since_s_ = is_first ? 0.0 : since_s_ + dt_s_;
    share_ = is_first ? 1.0 : 1.0 - std::exp(-dt_s_ / smoothing_s);
    last_ns_ = time_ns;
  }
  /// The condition does not hold any more.
  void interrupt() { *this = {}; }

  [[nodiscard]] double dt_s() const { return dt_s_; }        ///< since the scan before; 0 for the first
  [[nodiscard]] double since_s() const { return since_s_; }  ///< the first
  [[nodiscard]] double share() const { return share_; }      ///< of the new value in a smoothed one; 1 for the first

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  std::int64_t last_ns_ = kNever;
  double dt_s_ = 0.0, since_s_ = 0.0, share_ = 1.0;
};

}  // namespace boresight::health
