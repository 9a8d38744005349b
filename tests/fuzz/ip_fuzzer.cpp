// Packets of every link layer, one after another through one decoder. The input is a list of packets, each after its
// link layer and length.
#include <cstdlib>

#include <pcap/dlt.h>

#include "services/common/recording/link_layer.hpp"

using namespace boresight::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<int, 9> kLinks = {DLT_EN10MB, DLT_RAW,        DLT_NULL,          DLT_LOOP, DLT_LINUX_SLL,
                                         DLT_IPV6,   DLT_LINUX_SLL2, DLT_CAN_SOCKETCAN, DLT_IPV4};
  static UdpDecoder decoder;  // static, since it is large; it keeps its state from input to input
  std::span<const std::uint8_t> rest(data, size);
  Frame frame;
  while (rest.size() >= 3) {
    const int link = kLinks[rest[0] % kLinks.size()];
    const std::size_t length = std::min<std::size_t>(rest[1] << 8 | rest[2], rest.size() - 3);
    frame.stamp_ns += 1'000'000;
    const PacketResult result = decode_packet(rest.subspan(3, length), link, decoder, frame);
    if (describe(result).empty()) std::abort();
    if (result == PacketResult::kFrame) {
      unsigned sum = 0;
      for (const std::uint8_t byte : frame.payload) sum += byte;  // the sanitizer finds a view beyond the memory
      if (frame.payload.size() > 65536 || sum > 255u * 65536u) std::abort();
      if (frame.kind != FrameKind::kUdp && frame.payload.size() > 64) std::abort();
    }
    rest = rest.subspan(3 + length);
  }
  if (decoder.unfinished() > 16) std::abort();
  return 0;
}
