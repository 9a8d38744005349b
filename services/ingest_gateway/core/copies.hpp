// Counts detections that are bitwise equal to another one of the same scan.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::ingest {

/// A hash table without clearing: a mark distinguishes entries of earlier scans. No allocation.
class CopyCounter {
 public:
  /// Number of detections that equal an earlier one of the scan in every bit of range, azimuth and range rate.
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

/// Hash over every bit of all detections of the scan.
[[nodiscard]] std::uint64_t fingerprint(const RadarScan& scan, std::size_t detections);

}  // namespace boresight::ingest
