#include "services/common/recording/packet_decoder.hpp"

#include "services/common/recording/link_layer.hpp"

namespace boresight::recording {

void PacketDecoder::problem(std::string_view text) {
  ++counts_.problems;
  on_problem_(file_ + ": packet " + std::to_string(number_) + ": " + std::string(text));
}

bool PacketDecoder::take(CaptureInterface& interface, std::int64_t seconds, std::int64_t nanoseconds,
                         std::span<const std::uint8_t> packet, std::size_t original_size, Frame& frame) {
  if (seconds < 0 || seconds > kLastStamp_s) {
    problem("time stamp is not between 1970 and March 2255");
    return false;
  }
  frame = Frame{};
  frame.stamp_ns = seconds * 1'000'000'000 + nanoseconds;
  const PacketResult result = decode_packet(packet, interface.link_type, interface.udp, frame);
  for (; interface.given_up < interface.udp.given_up(); ++interface.given_up) {
    problem(describe(PacketResult::kFragmentLost));
  }
  if (result == PacketResult::kErrorFrame) ++counts_.error_frames;
  if (result == PacketResult::kIgnored) ++counts_.ignored;
  if (result == PacketResult::kTruncated && packet.size() < original_size) {
    problem("only " + std::to_string(packet.size()) + " of " + std::to_string(original_size) +
            " bytes were captured (snapshot length)");
  } else if (is_problem(result)) {
    problem(describe(result));
  }
  if (result != PacketResult::kFrame) return false;
  if (frame.kind != FrameKind::kUdp) frame.set_interface(interface.can_name);
  if (frame.stamp_ns < last_stamp_ns_) ++counts_.backwards;
  last_stamp_ns_ = frame.stamp_ns;
  ++counts_.frames;
  return true;
}

void PacketDecoder::end(const CaptureInterface& interface) {
  if (interface.udp.unfinished() == 0) return;
  problem(std::to_string(interface.udp.unfinished()) + " datagrams are incomplete at the end of the capture");
}

}  // namespace boresight::recording
