// A sequential test between two hypotheses on a radar, which is sound at first and may change at any time.
// Equations: docs/algorithms/ingest.md (I7), (I8).
#pragma once

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

/// Cumulative sum of log likelihood ratios (Page 1954) towards the other hypothesis, with a return by the same test.
class SequentialTest {
 public:
  /// Probabilities that a decision is wrong: that a sound radar is accused, and that a wrong one is acquitted.
  explicit SequentialTest(double false_alarm, double false_return)
      : alarm_(-std::log(false_alarm)), return_(-std::log(false_return)) {}

  /// `log_ratio`: log likelihood ratio of "contradicts" to "sound" in one scan. `dependent_scans`: scans whose noise is
  /// that of one independent scan. `least_scans`: fewer never decide, whatever they contain.
  void add(double log_ratio, double dependent_scans, double least_scans) {
    const double limit = contradicts_ ? return_ : alarm_;
    const double step = std::clamp(log_ratio / dependent_scans, -limit / least_scans, limit / least_scans);
    sum_ = std::max(0.0, sum_ + (contradicts_ ? -step : step));
    if (sum_ < limit) return;
    contradicts_ = !contradicts_;
    sum_ = 0.0;
  }
  [[nodiscard]] bool contradicts() const { return contradicts_; }
  /// True if nothing speaks for the other hypothesis.
  [[nodiscard]] bool is_settled() const { return sum_ == 0.0; }

 private:
  double alarm_, return_;  ///< limits of the sum
  double sum_ = 0.0;
  bool contradicts_ = false;
};

}  // namespace boresight::ingest
