#include "services/ingest_gateway/core/copies.hpp"

#include <bit>
#include <cstring>

namespace boresight::ingest {

namespace {

/// One round of a multiplicative hash; the shift moves the high bits, which the product mixes best, down.
std::uint64_t mix(std::uint64_t state, std::uint64_t word) {
  const std::uint64_t product = (state ^ word) * 0x9E3779B97F4A7C15u;
  return product ^ (product >> 29);
}

std::uint64_t mix_column(std::uint64_t state, const DetectionColumn<float>& column, std::size_t detections) {
  std::size_t i = 0;
  for (; i + 2 <= detections; i += 2) {
    std::uint64_t word = 0;
    std::memcpy(&word, column.data() + i, sizeof word);
    state = mix(state, word);
  }
  return i < detections ? mix(state, std::bit_cast<std::uint32_t>(column[i])) : state;
}

}  // namespace

std::size_t CopyCounter::count(const RadarScan& scan, std::size_t detections) {
  ++mark_;
  std::size_t copies = 0;
  for (std::size_t i = 0; i < detections; ++i) {
    const std::uint64_t position = static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(scan.range_m[i])) << 32 |
                                   std::bit_cast<std::uint32_t>(scan.azimuth_rad[i]);
    const std::uint64_t key = mix(mix(1, position), std::bit_cast<std::uint32_t>(scan.range_rate_mps[i]));
    std::size_t slot = key % kSlots;
    while (slots_[slot].mark == mark_ && slots_[slot].key != key) slot = (slot + 1) % kSlots;
    if (slots_[slot].mark == mark_) ++copies;
    slots_[slot] = {key, mark_};
  }
  return copies;
}

std::uint64_t fingerprint(const RadarScan& scan, std::size_t detections) {
  std::uint64_t state = mix(2, detections);
  state = mix_column(state, scan.range_m, detections);
  state = mix_column(state, scan.azimuth_rad, detections);
  state = mix_column(state, scan.range_rate_mps, detections);
  return scan.has(scan_field::kElevation) ? mix_column(state, scan.elevation_rad, detections) : state;
}

}  // namespace boresight::ingest
