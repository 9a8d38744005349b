// Fuzzer of the Toyota radar and ego codecs. The input is a sequence of frames on one bus. Checksums are corrected
// unless the input chooses otherwise.
#include <array>

#include "interfaces/wire/toyota.hpp"
#include "services/ingest_gateway/codecs/toyota_ego.hpp"
#include "services/ingest_gateway/codecs/toyota_radar.hpp"
#include "tests/fuzz/checked_output.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace boresight;
  namespace layout = wire::toyota;
  static constexpr std::array<std::uint32_t, 4> kEgoIds{layout::kYawRateId, layout::kSteeringId, layout::kWheelSpeedsId,
                                                        layout::kSpeedId};
  fuzz::Input input(data, size);
  ingest::ToyotaRadar radar;
  ingest::ToyotaEgo ego;
  fuzz::CheckedOutput output;
  const fuzz::NoAllocation guard;
  std::int64_t now_ns = 1'000'000'000;
  while (!input.empty()) {
    // Bits 0 … 4: track frame; 5: an ego frame instead; 6, 7: checksum unchanged, another length, a pause.
    const std::uint8_t choice = input.u8();
    const unsigned special = choice >> 6;
    std::array<std::uint8_t, 64> bytes{};
    std::size_t length = 8;
    if (special == 2) length = input.u8() % 65;
    if (special == 3) now_ns += static_cast<std::int64_t>(input.u8()) * 1'000'000;
    const auto content = input.bytes(length);
    std::copy(content.begin(), content.end(), bytes.begin());
    recording::Frame frame;
    frame.can_id = (choice & 0x20) != 0 ? kEgoIds[choice % kEgoIds.size()] : layout::kTrackA + (choice & 0x1Fu);
    frame.payload = std::span(bytes).first(length);
    if (special != 1 && length > 0) bytes[length - 1] = layout::checksum(frame.can_id, frame.payload);
    const ingest::FrameStamp stamp{now_ns, 0, TimeSource::kLinkArrival};
    radar.tick(now_ns, output);
    radar.take(frame, stamp, output);
    ego.take(frame, stamp, output);
    output.require_at_rest();
    now_ns += 200'000;
  }
  return 0;
}
