// Fuzzer of the SRR520 codec. The input is a sequence of frames. Some bytes choose to close a list with the right CRC
// or to fill it, so that the fuzzer passes the checksum. Every published scan must be possible.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "services/common/e2e/crc.hpp"
#include "services/ingest_gateway/codecs/srr520.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace boresight;
using fuzz::require;
namespace layout = wire::srr520;

/// Checks what comes out.
class Output : public ingest::DecoderOutput {
 public:
  RadarScan* begin_scan() override { return fuzz::stale(scan_); }
  void publish_scan(const ingest::FrameStamp&, const std::optional<ingest::SensorStamp>& sensor,
                    unsigned bits) override {
    require(sensor.has_value() && bits == 32);
    fuzz::require_possible(scan_);
    require(scan_.number_of_valid_detections <= 500);
    for (std::size_t i = 0; i < scan_.number_of_valid_detections; ++i) {
      require(scan_.range_m[i] >= 0.0F && scan_.range_m[i] < 100.1F);
      require(std::abs(scan_.azimuth_rad[i]) < 1.6F);
      require(std::abs(scan_.range_rate_mps[i]) < 15.1F);
    }
  }
  void discard_scan() override { std::abort(); }
  void report_conditions(std::uint32_t) override {}
  void take_ego(const ingest::EgoReading& reading, const ingest::FrameStamp&) override {
    require(std::abs(reading.speed_mps.value_or(0.0)) <= 100.1);
    require(std::abs(reading.yaw_rate_radps.value_or(0.0)) <= 3.15);
  }
  void fault(Fault, std::string_view what) override { require(!what.empty()); }

 private:
  static inline RadarScan scan_;
};

class Bus {
 public:
  void send(std::uint32_t id, std::span<const std::uint8_t> payload) {
    recording::Frame frame;
    frame.kind = recording::FrameKind::kCanFd;
    frame.can_id = id;
    frame.payload = payload;
    decoder_.take(frame, {now_ns_, 0, TimeSource::kLinkArrival}, output_);
    now_ns_ += 100'000;
  }
  void wait(std::int64_t duration_ns) {
    now_ns_ += duration_ns;
    decoder_.tick(now_ns_, output_);
  }

 private:
  ingest::Srr520 decoder_;
  Output output_;
  std::int64_t now_ns_ = 1'000'000'000;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* input, std::size_t size) {
  static const std::array<std::uint32_t, 8> kIds{layout::kStatusId,       layout::kClosingId,     layout::kNearHeaderId,
                                                 layout::kNearRecordId,   layout::kHrrHeaderId,   layout::kHrrRecordId,
                                                 layout::kObjectHeaderId, layout::kObjectRecordId};
  Bus bus;
  const fuzz::NoAllocation guard;
  std::span<const std::uint8_t> rest(input, size);
  const auto take = [&rest](std::size_t bytes) {
    const auto taken = rest.first(std::min(bytes, rest.size()));
    rest = rest.subspan(taken.size());
    return taken;
  };
  while (rest.size() >= 2) {
    const std::uint8_t choice = take(1)[0];
    if (choice < 224) {
      const std::size_t length = take(1)[0] % 66;
      bus.send(kIds[choice % kIds.size()], take(length));
    } else if (choice < 232) {
      bus.wait(choice % 8 * 20'000'000);
    } else {
      // A complete list: header and detections from the input, closed with the right CRC.
      const std::size_t kind = choice % layout::kLists.size();
      const layout::ListLayout& list = layout::kLists[kind];
      std::array<std::uint8_t, layout::kHeaderBytes + layout::kMaxRecordFrames * layout::kRecordFrameBytes> bytes{};
      const auto all = std::span(bytes).first(layout::kHeaderBytes + list.number_of_frames * layout::kRecordFrameBytes);
      const auto content = take(400);
      std::copy_n(content.begin(), std::min(content.size(), all.size()), all.begin());
      bus.send(list.header_id, all.first(layout::kHeaderBytes));
      for (std::size_t i = 0; i < list.number_of_frames; ++i) {
        const auto record =
            all.subspan(layout::kHeaderBytes + i * layout::kRecordFrameBytes, layout::kRecordFrameBytes);
        record[layout::kFrameNumber] = static_cast<std::uint8_t>(i);
        record[layout::kFrameSequence] = all[layout::header::kSequenceCounter];
        bus.send(list.record_id, record);
      }
      const std::uint16_t crc = e2e::crc16_ccitt_false(all);
      const std::array<std::uint8_t, layout::kClosingBytes> closing{static_cast<std::uint8_t>(kind),
                                                                    static_cast<std::uint8_t>(crc >> 8),
                                                                    static_cast<std::uint8_t>(crc & 0xFF), 0};
      bus.send(layout::kClosingId, closing);
    }
  }
  return 0;
}
