// Intervals that hold the true value of a figure with 95 % confidence.
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/common/statistics.hpp"

namespace boresight::bench {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// "0.024 (0.019–0.03)"
[[nodiscard]] inline std::string with_interval(double figure, const Interval& interval) {
  return number(figure) + " (" + number(interval.low) + "–" + number(interval.high) + ")";
}

/// Bootstrap over `count` drives: `statistic` gets the indices of as many drives, drawn with replacement. The draws are
/// the same in every call, so that two figures of the same drives are compared on the same draws.
template <typename Statistic>
[[nodiscard]] Interval bootstrap(std::size_t count, Statistic&& statistic) {
  constexpr std::size_t kDraws = 1000;
  std::mt19937_64 random(1);
  std::vector<double> values;
  std::vector<std::size_t> picks(count);
  for (std::size_t draw = 0; draw < kDraws && count > 0; ++draw) {
    for (std::size_t& pick : picks) pick = static_cast<std::size_t>(random() % count);
    const double value = statistic(picks);
    if (!std::isnan(value)) values.push_back(value);
  }
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

/// The same of the median of values, one a drive.
[[nodiscard]] inline Interval median_interval(const std::vector<double>& values) {
  return bootstrap(values.size(), [&](const std::vector<std::size_t>& picks) {
    std::vector<double> picked;
    for (const std::size_t pick : picks) picked.push_back(values[pick]);
    return median(std::move(picked));
  });
}

/// Of the mean of a Poisson distribution of which `count` was seen: exact, by bisection.
[[nodiscard]] inline Interval poisson_interval(std::size_t count) {
  constexpr double kTail = 0.025;
  const auto at_most = [](std::size_t n, double mean) {  // P(X ≤ n); logarithms, since e^−mean may be 0
    double sum = 0.0;
    for (std::size_t i = 0; i <= n; ++i) {
      const auto count_i = static_cast<double>(i);
      sum += std::exp(count_i * std::log(mean) - mean - std::lgamma(count_i + 1.0));
    }
    return sum;
  };
  const auto mean_with = [&](std::size_t n, double share) {  // P(X ≤ n) = share
    double low = 0.0, high = 20.0 + 4.0 * static_cast<double>(n);
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (at_most(n, middle) > share ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
  return {count == 0 ? 0.0 : mean_with(count - 1, 1.0 - kTail), mean_with(count, kTail)};
}

/// Exponent of a cost that grows from `first` to `last` while its cause grows `growth`-fold.
[[nodiscard]] inline double exponent(double first, double last, double growth) {
  return std::log(last / first) / std::log(growth);
}

}  // namespace boresight::bench
