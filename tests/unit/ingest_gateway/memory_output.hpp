// Keeps a decoder's output in memory.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/ingest_gateway/codecs/decoder.hpp"
#include "tests/unit/ingest_gateway/fault_counts.hpp"

namespace boresight::ingest {

/// Allocates only in the constructor, and for the texts of faults.
class MemoryOutput : public DecoderOutput, public FaultCounts {
 public:
  RadarScan* begin_scan() override { return refuse_memory ? nullptr : scan.get(); }
  void publish_scan(const FrameStamp& reception, const std::optional<SensorStamp>& sensor, unsigned bits) override {
    ++scans;
    last_reception = reception;
    last_sensor = sensor;
    last_counter_bits = bits;
  }
  void discard_scan() override { ++discarded; }
  void report_conditions(std::uint32_t bits) override { conditions = bits; }
  void take_ego(const EgoReading& reading, const FrameStamp& reception) override {
    ++ego_readings;
    last_ego = reading;
    last_reception = reception;
  }
  void fault(Fault kind, std::string_view what) override {
    ++faults[static_cast<std::size_t>(kind)];
    last_fault = what;
  }

  std::unique_ptr<RadarScan> scan = std::make_unique<RadarScan>();
  bool refuse_memory = false;
  std::size_t scans = 0, discarded = 0, ego_readings = 0;
  FrameStamp last_reception{};
  std::optional<SensorStamp> last_sensor;
  unsigned last_counter_bits = 0;
  std::optional<std::uint32_t> conditions;
  EgoReading last_ego{};
  std::string last_fault;
};

/// A classic CAN frame that views `payload`.
[[nodiscard]] inline recording::Frame can_frame(std::uint32_t id, std::span<const std::uint8_t> payload) {
  recording::Frame frame;
  frame.kind = payload.size() > 8 ? recording::FrameKind::kCanFd : recording::FrameKind::kCan;
  frame.can_id = id;
  frame.can_extended = id > 0x7FF;
  frame.payload = payload;
  return frame;
}

}  // namespace boresight::ingest
