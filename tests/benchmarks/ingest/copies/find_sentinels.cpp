#include "tests/benchmarks/ingest/copies/find_sentinels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace boresight::bench {

namespace {

constexpr std::uint32_t kPattern = 0x43290000, kMask = 0xFFFF003F;  // 169 … 170 m
constexpr unsigned kShift = 6;

struct Region {
  std::uintptr_t begin, end;
};

/// Memory that can hold a copy: the writable regions of this process.
std::vector<Region> writable_regions() {
  std::vector<Region> regions;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::istringstream fields(line);
    Region region{};
    char dash = 0;
    std::string rights;
    fields >> std::hex >> region.begin >> dash >> region.end >> rights;
    if (rights.starts_with("rw")) regions.push_back(region);
  }
  return regions;
}

using Counts = std::array<std::size_t, SentinelPlaces::kSentinels>;

std::ptrdiff_t median_difference(const Counts& before, const Counts& after, std::size_t size) {
  std::array<std::ptrdiff_t, SentinelPlaces::kSentinels> difference{};
  std::transform(after.begin(), after.end(), before.begin(), difference.begin(), std::minus<std::ptrdiff_t>());
  const auto middle = difference.begin() + static_cast<std::ptrdiff_t>(size / 2);
  std::nth_element(difference.begin(), middle, difference.begin() + static_cast<std::ptrdiff_t>(size));
  return *middle;
}

}  // namespace

float sentinel_range_m(std::size_t i) {
  return std::bit_cast<float>(kPattern | static_cast<std::uint32_t>(i % SentinelPlaces::kSentinels) << kShift);
}

SentinelPlaces find_sentinels() {
  SentinelPlaces places;
  for (const Region& region : writable_regions()) {
    const auto* p = reinterpret_cast<const std::uint8_t*>(region.begin);
    const auto* const end = reinterpret_cast<const std::uint8_t*>(region.end);
    for (; p + sizeof(std::uint32_t) <= end; ++p) {
      std::uint32_t word = 0;
      std::memcpy(&word, p, sizeof(word));
      if ((word & kMask) == kPattern) ++places.as_float[(word & ~kPattern) >> kShift];
      word = __builtin_bswap32(word);
      if ((word & kMask) == kPattern) ++places.on_wire_order[(word & ~kPattern) >> kShift];
    }
  }
  return places;
}

NewPlaces new_places(const SentinelPlaces& before, const SentinelPlaces& after, std::size_t detections) {
  detections = std::clamp<std::size_t>(detections, 1, SentinelPlaces::kSentinels);
  return {median_difference(before.on_wire_order, after.on_wire_order, detections),
          median_difference(before.as_float, after.as_float, detections)};
}

}  // namespace boresight::bench
