// What the radars of a vehicle deviate by together: an error of speed, yaw rate or body moves all of them, a knock one.
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

/// Median of the others (sorted in place; of an even number the smaller of the middle two), which is what a radar that
/// deviates by `own_rad` has in common with them; nothing if there are none. Of two radars the one that deviates more
/// is the one that moved: the other's common part is all of its own.
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
