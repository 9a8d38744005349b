// Tables of a profile: values by range, and quantiles.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "services/simulator/radar/profile.hpp"

namespace boresight::simulator::radar {

/// Linear between the knots, constant beyond them. `knots` increase.
template <std::size_t N>
[[nodiscard]] double interpolated(const std::array<double, N>& knots, const std::array<double, N>& values, double at) {
  if (!(at > knots.front())) return values.front();
  for (std::size_t i = 1; i < N; ++i) {
    if (at < knots[i]) {
      return values[i - 1] + (values[i] - values[i - 1]) * (at - knots[i - 1]) / (knots[i] - knots[i - 1]);
    }
  }
  return values.back();
}

/// The value at a share 0 … 1 of a distribution with these quantiles. `low` and `high` are its bounds.
[[nodiscard]] inline double value_at(double share, const std::array<double, 5>& shares, const FiveQuantiles& values,
                                     double low, double high) {
  const std::array<double, 7> knots = {0.0, shares[0], shares[1], shares[2], shares[3], shares[4], 1.0};
  const std::array<double, 7> all = {low, values[0], values[1], values[2], values[3], values[4], high};
  return interpolated(knots, all, share);
}
inline constexpr std::array<double, 5> kFrom10To90 = {0.10, 0.25, 0.50, 0.75, 0.90};
inline constexpr std::array<double, 5> kFrom5To95 = {0.05, 0.25, 0.50, 0.75, 0.95};

/// The Poisson number at a share 0 … 1 of its distribution.
[[nodiscard]] inline unsigned poisson_at(double share, double mean) {
  double probability = std::exp(-mean), sum = probability;
  unsigned count = 0;
  while (share >= sum && count < 200) {
    ++count;
    probability *= mean / count;
    sum += probability;
  }
  return count;
}

}  // namespace boresight::simulator::radar
