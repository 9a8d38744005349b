// The deviation that the radars of a vehicle have in common. An error of speed, yaw rate or body moves all radars, a
// step change of a mounting only one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace boresight::alignment {

struct Deviation {
  double value_rad = 0.0;
  double variance = 0.0;
};

/// Median of the other radars' deviations: the part that a radar with the deviation `own_rad` has in common with them.
/// Sorts in place; for an even number the smaller of the middle two; zero without other radars. With two radars, the
/// one with the larger deviation is taken as moved: for the other one all of its deviation is common.
[[nodiscard]] inline Deviation common_mode(std::span<Deviation> others, double own_rad) {
  if (others.empty()) return {};
  std::sort(others.begin(), others.end(),
            [](const Deviation& a, const Deviation& b) { return a.value_rad < b.value_rad; });
  const Deviation& low = others[(others.size() - 1) / 2];
  const Deviation& high = others[others.size() / 2];
  Deviation middle = std::abs(low.value_rad) < std::abs(high.value_rad) ? low : high;
  if (others.size() == 1 && std::abs(own_rad) <= std::abs(middle.value_rad)) middle.value_rad = own_rad;
  return middle;
}

}  // namespace boresight::alignment
