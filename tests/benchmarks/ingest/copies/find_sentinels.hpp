// Where detections stand in memory, found by looking: to count the copies that are made on the way to the scan.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boresight::bench {

/// Sanitizers forbid to look everywhere.
#ifdef BORESIGHT_SANITIZED
inline constexpr bool kCanFindSentinels = false;
#else
inline constexpr bool kCanFindSentinels = true;
#endif

/// A range that only detection `i` of 1024 has and that does not come about by chance.
[[nodiscard]] float sentinel_range_m(std::size_t i);

/// In how many places of this process's memory a sentinel stands: the median over the first `detections`, since a
/// register may leave single ones on the stack.
struct SentinelPlaces {
  std::size_t on_wire_order = 0;  ///< most significant byte first, as in a datagram
  std::size_t as_float = 0;       ///< as in a scan
};
[[nodiscard]] SentinelPlaces find_sentinels(std::size_t detections);

}  // namespace boresight::bench
