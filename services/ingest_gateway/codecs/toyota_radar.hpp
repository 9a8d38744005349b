// Toyota radar: 2 × 16 CAN frames a cycle → one scan of the valid tracks.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/wire/toyota.hpp"
#include "services/ingest_gateway/codecs/result.hpp"

namespace boresight::ingest {

/// Collects the frames of one cycle. A cycle is complete with the last of its 32 frames, in whatever order they come,
/// or, if frames are missing, when the next cycle begins; the caller then writes it out by write_scan(). The radar
/// reports tracks of its own: range and azimuth are computed from its Cartesian position; it measures no elevation and
/// no RCS.
class ToyotaRadar {
 public:
  /// Takes one frame. kComplete: the collected cycle is ready. If the frame began a new cycle while the old one was
  /// incomplete, the result is kComplete too and the frame has NOT been taken: call write_scan() and pass it again.
  [[nodiscard]] DecodeResult take(std::uint32_t id, std::span<const std::uint8_t> payload, std::int64_t stamp_ns,
                                  std::string_view& problem);

  /// Writes all fields but the header and clears the cycle.
  void write_scan(RadarScan& scan);
  /// Clears the cycle without writing it.
  void discard();

  /// Stamp of the first frame of the collected cycle.
  [[nodiscard]] std::int64_t stamp_ns() const { return stamp_ns_; }
  /// Frames of the 32 that the cycle written last lacked.
  [[nodiscard]] std::uint32_t missing_frames() const { return missing_; }

 private:
  struct Slot {
    bool valid = false;
    double longitudinal_m = 0.0, lateral_m = 0.0, relative_speed_mps = 0.0;
    double score_percent = 0.0;
    bool has_score = false;
  };
  std::array<Slot, wire::toyota::kNumberOfTracks> slots_{};
  std::uint32_t frames_ = 0;
  std::uint32_t seen_a_ = 0;
  std::uint32_t seen_b_ = 0;
  std::uint32_t counter_ = 0;
  std::uint32_t missing_ = 0;
  std::int64_t stamp_ns_ = 0;
  std::int64_t last_stamp_ns_ = 0;
};

}  // namespace boresight::ingest
