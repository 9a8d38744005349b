#include "services/common/recording/socketcan.hpp"

namespace boresight::recording {

PacketResult decode_socketcan(std::span<const std::uint8_t> packet, std::endian id_order, Frame& frame) {
  constexpr std::uint32_t kExtended = 0x80000000, kRemote = 0x40000000, kError = 0x20000000;
  constexpr std::uint8_t kXlFlag = 0x80, kFdFlag = 0x04, kBitRateSwitch = 0x01, kErrorState = 0x02;
  constexpr std::size_t kHeader = 8, kFdPacket = 72;
  if (packet.size() < kHeader) return PacketResult::kTruncated;
  // In CAN XL, the fifth byte holds flags, and this one is always set. No valid length is as large.
  if ((packet[4] & kXlFlag) != 0) return PacketResult::kUnsupported;
  std::uint32_t id = 0;
  for (std::size_t i = 0; i < 4; ++i) id = id << 8 | packet[id_order == std::endian::big ? i : 3 - i];
  if ((id & kError) != 0) return PacketResult::kErrorFrame;
  const std::size_t length = packet[4];
  // Captures before libpcap 1.10 lack the flag, but have the size of the kernel's structure.
  const bool is_fd = length > 8 || (packet[5] & kFdFlag) != 0 || packet.size() == kFdPacket;
  if (length > 64) return PacketResult::kBadHeader;
  frame.can_remote = !is_fd && (id & kRemote) != 0;
  if (!frame.can_remote && packet.size() < kHeader + length) return PacketResult::kTruncated;
  frame.kind = is_fd ? FrameKind::kCanFd : FrameKind::kCan;
  frame.can_fd_flags = is_fd ? static_cast<std::uint8_t>(packet[5] & (kBitRateSwitch | kErrorState)) : 0;
  frame.can_extended = (id & kExtended) != 0;
  frame.can_id = id & (frame.can_extended ? 0x1FFFFFFFu : 0x7FFu);
  frame.payload = packet.subspan(kHeader, frame.can_remote ? 0 : length);
  return PacketResult::kFrame;
}

}  // namespace boresight::recording
