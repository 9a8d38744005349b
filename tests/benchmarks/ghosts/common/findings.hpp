// Tables and curves of a run, and how many bars (required values) are met.
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench {

/// A bar: the required range of a figure. Without limits: no bar.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};
[[nodiscard]] inline Limits at_most(double high) {
  return {-std::numeric_limits<double>::infinity(), high};
}
[[nodiscard]] inline Limits at_least(double low) {
  return {low, std::numeric_limits<double>::infinity()};
}

class Findings {
 public:
  /// "met", "missed", "no data", or "—" without a bar. A miss inside the interval is met.
  [[nodiscard]] std::string judge(const Interval& figure, const Limits& limits);
  /// Prints the table at once, since runs take minutes.
  void add(Table table);
  void add(Curve curve) { report_.add(std::move(curve)); }
  /// Prints the number of bars met. Writes files whose names are not empty; throws std::runtime_error if it cannot.
  void finish(const std::string& json, const std::string& markdown) const;

  [[nodiscard]] std::size_t met() const { return met_; }
  [[nodiscard]] std::size_t missed() const { return missed_; }

 private:
  Report report_;
  std::size_t met_ = 0, missed_ = 0, without_data_ = 0;
};

/// "≤ 0.6", "≥ 97.7", "0.5–2", "—".
[[nodiscard]] std::string text_of(const Limits& limits);

}  // namespace boresight::bench
