// Median and median deviation, in place and without allocation.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace boresight::estimation {

/// The middle value, or the mean of the middle two. Needs at least one value and no NaN. Sorts the values in part.
[[nodiscard]] inline double median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Standard deviation of a normal distribution with the values' median absolute deviation from `centre`. Overwrites the
/// values.
[[nodiscard]] inline double mad_std(std::span<double> values, double centre) {
  constexpr double kSigmaOfMad = 1.4826;
  for (double& value : values) value = std::abs(value - centre);
  return kSigmaOfMad * median(values);
}

}  // namespace boresight::estimation
