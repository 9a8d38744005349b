// Finds detections that are bit-identical to another one of the same scan.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::ingest {

/// A hash table that needs no clearing: entries of earlier scans are told by their mark. No allocation.
class CopyCounter {
 public:
  /// Detections that agree to the last bit with an earlier one of the scan in range, azimuth and range rate.
  [[nodiscard]] std::size_t count(const RadarScan& scan, std::size_t detections);

 private:
  // Twice as many as detections, so that probing stays short.
  static constexpr std::size_t kSlots = 2 * kMaxDetections;
  struct Slot {
    std::uint64_t key;
    std::uint64_t mark;
  };
  std::array<Slot, kSlots> slots_{};
  std::uint64_t mark_ = 0;
};

/// Of all detections of the scan, to the last bit.
[[nodiscard]] std::uint64_t fingerprint(const RadarScan& scan, std::size_t detections);

}  // namespace boresight::ingest
