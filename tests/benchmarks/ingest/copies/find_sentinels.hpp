// Finds detections in memory by searching for unique values, to count the copies on their path to the scan.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boresight::bench {

/// Sanitizers do not permit reading all memory.
#ifdef BORESIGHT_SANITIZED
inline constexpr bool kCanFindSentinels = false;
#else
inline constexpr bool kCanFindSentinels = true;
#endif

/// A range that only detection `i` of 1024 has and that does not occur by chance.
[[nodiscard]] float sentinel_range_m(std::size_t i);

/// Number of places of a sentinel in this process's memory: the median over the first `detections`, since single copies
/// may remain on the stack.
struct SentinelPlaces {
  std::size_t on_wire_order = 0;  ///< most significant byte first, as in a datagram
  std::size_t as_float = 0;       ///< as in a scan
};
[[nodiscard]] SentinelPlaces find_sentinels(std::size_t detections);

}  // namespace boresight::bench
