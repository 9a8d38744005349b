// Short mathematical helpers of the filters.
#pragma once

#include <cstdint>

namespace boresight::alignment {

[[nodiscard]] inline double square(double v) {
  return v * v;
}
[[nodiscard]] inline double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

}  // namespace boresight::alignment
