// Any segments in any order from two senders. A delivered message must have the announced length. The messages of a
// third sender, sent in between, must always arrive unchanged.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "services/ingest_gateway/codecs/someip/tp.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace boresight;
using namespace boresight::ingest::someip;

constexpr std::size_t kMaxMessageBytes = 1024;
constexpr recording::Endpoint kBystander{recording::IpAddress::v4(0x0A000003), 30501};

TpResult take_own(TpReassembler& tp, std::uint16_t session, std::uint8_t part, std::int64_t now_ns, Message& complete) {
  // Two segments of 16 and 8 bytes.
  std::array<std::uint8_t, 20> payload{0, 0, 0, static_cast<std::uint8_t>(part == 0 ? 1 : 16)};
  std::fill(payload.begin() + 4, payload.end(), static_cast<std::uint8_t>(session + part));
  Message message;
  message.service = 0x4321;
  message.session = session;
  message.tp = true;
  message.payload = std::span<const std::uint8_t>(payload).first(part == 0 ? 20 : 12);
  return tp.take(message, kBystander, now_ns, complete);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // More assemblies than the fuzzer can make keys in between, so the third sender's assembly is never evicted.
  TpReassembler tp(8, kMaxMessageBytes, 1000);
  std::int64_t now_ns = 0;
  std::uint16_t session = 0;
  Message complete;
  const fuzz::NoAllocation guard;
  while (size > 7) {
    // A segment: kind, session, time, flags, then the TP header in wire format and up to 255 bytes.
    Message segment;
    segment.method = data[0] & 1;
    segment.session = static_cast<std::uint16_t>(data[1] % 4);
    segment.tp = (data[0] & 0x80) == 0;
    const recording::Endpoint sender{recording::IpAddress::v4(0x0A000001),
                                     static_cast<std::uint16_t>(data[0] >> 1 & 1)};
    now_ns += data[2];
    const std::size_t length = std::min<std::size_t>(data[3], size - 4);
    segment.payload = {data + 4, length};
    data += 4 + length;
    size -= 4 + length;

    ++session;
    if (take_own(tp, session == 0 ? ++session : session, 0, now_ns, complete) != TpResult::kAccepted) std::abort();
    if (tp.take(segment, sender, now_ns, complete) == TpResult::kComplete) {
      if (complete.tp || complete.payload.empty() || complete.payload.size() > kMaxMessageBytes) std::abort();
      if (complete.protected_data.size() != complete.payload.size() + kLengthCountsBytes) std::abort();
      // Reads every byte, for the sanitizers.
      volatile std::uint8_t sum = 0;
      for (const std::uint8_t b : complete.protected_data) sum = static_cast<std::uint8_t>(sum + b);
    }
    if (take_own(tp, session, 1, now_ns, complete) != TpResult::kComplete) std::abort();
    if (complete.payload.size() != 24) std::abort();
    for (std::size_t i = 0; i < 24; ++i) {
      if (complete.payload[i] != static_cast<std::uint8_t>(session + (i < 16 ? 0 : 1))) std::abort();
    }
  }
  return 0;
}
