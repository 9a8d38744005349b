// Toyota radar: 2 × 16 CAN frames per cycle → one scan of the valid tracks.
#pragma once

#include <array>
#include <cstdint>

#include "interfaces/wire/toyota.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// Collects the frames of one cycle. A cycle is complete with the last of its 32 frames, in any order. If frames are
/// missing, the cycle ends when the next one begins or after 20 ms without a frame, and is published as kIncomplete.
/// The radar reports its own tracks: range and azimuth are computed from the Cartesian position. It measures no
/// elevation and no RCS.
class ToyotaRadar : public Decoder {
 public:
  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;
  void tick(std::int64_t now_ns, DecoderOutput& output) override;

 private:
  struct Slot {
    bool valid = false;
    double longitudinal_m = 0.0, lateral_m = 0.0, relative_speed_mps = 0.0;
    double score_percent = 0.0;
    bool has_score = false;
  };
  void finish(DecoderOutput& output);
  void write_scan(RadarScan& scan) const;
  std::array<Slot, wire::toyota::kNumberOfTracks> slots_{};
  std::uint32_t frames_ = 0;
  std::uint32_t seen_a_ = 0;
  std::uint32_t seen_b_ = 0;
  std::uint32_t counter_ = 0;
  FrameStamp first_;
  std::int64_t last_ns_ = 0;
};

}  // namespace boresight::ingest
