// Finds detections in memory by searching for unique values, to count the copies on their path to the scan.
#pragma once

#include <array>
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

/// Number of places of each sentinel in this process's memory.
struct SentinelPlaces {
  static constexpr std::size_t kSentinels = 1024;
  std::array<std::size_t, kSentinels> on_wire_order{};  ///< most significant byte first, as in a datagram
  std::array<std::size_t, kSentinels> as_float{};       ///< as in a scan
};
[[nodiscard]] SentinelPlaces find_sentinels();

/// Number of places that a sentinel has in `after` beyond those in `before`: the median over the first `detections`,
/// since parts of old copies remain on the stack and are overwritten.
struct NewPlaces {
  std::ptrdiff_t on_wire_order = 0, as_float = 0;
};
[[nodiscard]] NewPlaces new_places(const SentinelPlaces& before, const SentinelPlaces& after, std::size_t detections);

}  // namespace boresight::bench
