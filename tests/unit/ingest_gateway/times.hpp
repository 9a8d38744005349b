// Units of time of the gateway's tests.
#pragma once

#include <cstdint>

namespace boresight {

inline constexpr std::int64_t kMillisecond = 1'000'000;

}  // namespace boresight
