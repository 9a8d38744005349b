// Degrees and radians, for input and output only: inside, angles are radians.
#pragma once

#include <numbers>

namespace boresight {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

}  // namespace boresight
