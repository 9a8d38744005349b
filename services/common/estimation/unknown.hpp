// The value of unknown quantities.
#pragma once

#include <limits>

namespace boresight {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace boresight
