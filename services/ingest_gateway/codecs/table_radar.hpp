// CAN radar with a mapping file → scans.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/codecs/frame_guard.hpp"
#include "services/ingest_gateway/dbc/mapping.hpp"

namespace boresight::ingest {

/// Collects the parts of the detections of one cycle. Writes the valid detections with a position and a range rate, in
/// the order of their slots. The mapping defines begin and end of a cycle. A cycle with missing parts is published as
/// kIncomplete. Frames are found by binary search; nothing allocates after construction.
class TableRadar : public Decoder {
 public:
  explicit TableRadar(dbc::RadarMapping mapping);

  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;
  void tick(std::int64_t now_ns, DecoderOutput& output) override;

 private:
  using Payload = std::span<const std::uint8_t>;
  struct Slot {
    std::array<double, dbc::kNumberOfQuantities> values;  // those whose bit is set in `present`
    std::uint32_t present = 0;
    std::uint8_t parts = 0;   // bits of the received parts
    std::uint8_t judged = 0;  // bits of the received conditions
    bool valid = true;
    bool not_a_number = false;

    [[nodiscard]] double value(dbc::Quantity quantity) const {
      return (present & dbc::bit_of(quantity)) != 0 ? values[static_cast<std::size_t>(quantity)] : 0.0;
    }
  };
  static constexpr std::size_t kNoSlot = static_cast<std::size_t>(-1);

  /// False if the cycle cannot be used.
  [[nodiscard]] bool take_header(const dbc::RadarMessage& message, Payload payload, DecoderOutput& output);
  [[nodiscard]] bool began_before(const dbc::RadarMessage& message, Payload payload) const;
  void take_part(const dbc::DetectionPart& part, Payload payload, DecoderOutput& output);
  /// kNoSlot if the detection's number is out of range.
  [[nodiscard]] std::size_t slot_of(const dbc::DetectionPart& part, Payload payload) const;
  [[nodiscard]] bool is_complete(const dbc::RadarMessage& message) const;
  void finish(bool regularly, DecoderOutput& output);
  void write_scan(RadarScan& scan) const;
  [[nodiscard]] bool write_detection(const Slot& slot, std::size_t i, RadarScan& scan) const;
  void clear();

  dbc::RadarMapping mapping_;
  std::vector<std::uint64_t> keys_;  // of the messages, sorted
  std::vector<FrameGuard> guards_;
  std::vector<Slot> slots_;
  std::vector<std::uint8_t> conditions_;  // of each slot: bits of the conditions that hold
  std::vector<std::uint16_t> arrived_;    // by the first slot of a group: number of detections so far
  std::size_t begun_slots_ = 0, complete_slots_ = 0;
  std::uint32_t frames_ = 0;
  std::uint32_t expected_ = 0;  // detections, by the header
  std::uint16_t dropped_ = 0;
  bool has_header_ = false;
  bool reported_orphan_ = false;
  bool has_counter_ = false;
  std::uint32_t counter_ = 0;
  FrameStamp first_;
  std::int64_t last_ns_ = 0;
};

}  // namespace boresight::ingest
