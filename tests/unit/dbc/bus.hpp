// A CAN bus for tests: writes frames by the DBC file, one bit at a time, and keeps the output of a decoder.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/e2e/protector.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/dbc/dbc.hpp"

namespace boresight::ingest {

/// Writes raw bits by DBC numbering.
inline void put_bits(const dbc::Signal& signal, std::uint64_t bits, std::vector<std::uint8_t>& payload) {
  unsigned at = signal.start_bit;
  for (unsigned i = 0; i < signal.length; ++i) {
    const bool is_intel = signal.order == wire::ByteOrder::kIntel;
    const bool bit = (bits >> (is_intel ? i : signal.length - 1u - i) & 1u) != 0;
    const auto mask = static_cast<std::uint8_t>(1u << at % 8);
    payload[at / 8] = static_cast<std::uint8_t>(bit ? payload[at / 8] | mask : payload[at / 8] & ~mask);
    at = is_intel ? at + 1 : (at % 8 == 0 ? at + 15 : at - 1);
  }
}

/// The raw value nearest to a physical one.
inline std::uint64_t raw_of(const dbc::Signal& signal, double physical) {
  const double raw = (physical - signal.offset) / signal.factor;
  if (signal.kind == wire::SignalKind::kFloat32) return std::bit_cast<std::uint32_t>(static_cast<float>(raw));
  if (signal.kind == wire::SignalKind::kFloat64) return std::bit_cast<std::uint64_t>(raw);
  return static_cast<std::uint64_t>(std::llround(raw));
}

/// Keeps a decoder's output.
struct Recorder : DecoderOutput {
  struct Ego {
    EgoReading reading;
    std::int64_t stamp_ns;
  };
  RadarScan* begin_scan() override {
    if (refuse_memory) return nullptr;
    scans.push_back(std::make_unique<RadarScan>());
    return scans.back().get();
  }
  void publish_scan(const FrameStamp& reception, const std::optional<SensorStamp>&, unsigned bits) override {
    scans.back()->header.measurement_time_ns = reception.received_ns;
    counter_bits = bits;
  }
  void discard_scan() override { scans.pop_back(); }
  void report_conditions(std::uint32_t) override {}
  void take_ego(const EgoReading& reading, const FrameStamp& reception) override {
    egos.push_back({reading, reception.received_ns});
  }
  void fault(Fault, std::string_view what) override { faults.emplace_back(what); }

  bool refuse_memory = false;
  std::vector<std::unique_ptr<RadarScan>> scans;
  std::vector<Ego> egos;
  std::vector<std::string> faults;
  unsigned counter_bits = 99;
};

class Bus {
 public:
  using Values = std::map<std::string, double>;

  Bus(const dbc::Database& database, Decoder& decoder) : database_(database), decoder_(decoder) {}

  /// A frame of the named message with these physical values; other signals are 0.
  [[nodiscard]] std::vector<std::uint8_t> payload(const std::string& message, const Values& values) const {
    const dbc::Message& found = *database_.find(message);
    std::vector<std::uint8_t> bytes(found.length_bytes);
    for (const auto& [name, value] : values) {
      const dbc::Signal* const signal = found.find(name);
      if (signal == nullptr) {
        ADD_FAILURE() << "no signal " << name;
        continue;
      }
      put_bits(*signal, raw_of(*signal, value), bytes);
    }
    return bytes;
  }
  void send(const std::string& message, const Values& values) { send_bytes(message, payload(message, values)); }
  void send_bytes(const std::string& message, const std::vector<std::uint8_t>& bytes) {
    const dbc::Message& found = *database_.find(message);
    recording::Frame frame;
    frame.can_id = found.id + id_offset;
    frame.can_extended = found.extended;
    frame.payload = bytes;
    decoder_.take(frame, {now_ns, 0, TimeSource::kLinkArrival}, out);
    now_ns += 100'000;
  }
  void wait_ms(std::int64_t ms) {
    now_ns += ms * 1'000'000;
    decoder_.tick(now_ns, out);
  }

  Recorder out;
  std::int64_t now_ns = 1'000'000'000;
  std::uint32_t id_offset = 0;

 private:
  const dbc::Database& database_;
  Decoder& decoder_;
};

}  // namespace boresight::ingest
