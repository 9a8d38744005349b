#include "services/common/recording/link_layer.hpp"

#include <pcap/dlt.h>

#include "services/common/recording/socketcan.hpp"

namespace boresight::recording {

namespace {

std::uint16_t read_u16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

/// Protocol field of a Linux cooked capture: an EtherType, or the kernel's numbers for CAN.
PacketResult decode_cooked(std::span<const std::uint8_t> packet, std::uint16_t protocol, std::size_t header,
                           UdpDecoder& udp, Frame& frame) {
  constexpr std::uint16_t kCan = 0x000C, kCanFd = 0x000D, kCanXl = 0x000E;
  constexpr std::uint16_t kIpv4 = 0x0800, kIpv6 = 0x86DD, kVlan = 0x8100, kServiceVlan = 0x88A8;
  std::span<const std::uint8_t> rest = packet.subspan(header);
  if (protocol == kCanXl) return PacketResult::kUnsupported;
  if (protocol == kCan || protocol == kCanFd) return decode_socketcan(rest, std::endian::native, frame);
  for (int tags = 0; tags < 2 && (protocol == kVlan || protocol == kServiceVlan); ++tags) {
    if (rest.size() < 4) return PacketResult::kTruncated;
    protocol = read_u16(rest, 2);
    rest = rest.subspan(4);
  }
  if (protocol != kIpv4 && protocol != kIpv6) return PacketResult::kIgnored;
  return udp.decode(rest, LinkLayer::kRawIp, frame);
}

}  // namespace

bool is_supported_link(int link_type) {
  switch (link_type) {
    case DLT_EN10MB:
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_IPV6:
    case DLT_NULL:
    case DLT_LOOP:
    case DLT_LINUX_SLL:
    case DLT_LINUX_SLL2:
    case DLT_CAN_SOCKETCAN:
      return true;
    default:
      return false;
  }
}

int data_link_of(std::uint16_t link_type) {
  constexpr std::uint16_t kRaw = 101, kLoop = 108;  // DLT_RAW and DLT_LOOP are numbered by operating system
  if (link_type == kRaw) return DLT_RAW;
  return link_type == kLoop ? DLT_LOOP : link_type;
}

std::string_view supported_links() {
  return "Ethernet, raw IP, SocketCAN, Linux cooked v1 and v2, loopback";
}

PacketResult decode_packet(std::span<const std::uint8_t> packet, int link_type, UdpDecoder& udp, Frame& frame) {
  constexpr std::size_t kLoopbackHeader = 4, kCookedHeader = 16, kCooked2Header = 20;
  switch (link_type) {
    case DLT_EN10MB:
      return udp.decode(packet, LinkLayer::kEthernet, frame);
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_IPV6:
      return udp.decode(packet, LinkLayer::kRawIp, frame);
    case DLT_NULL:
    case DLT_LOOP:
      // The header is the address family, whose number depends on the operating system. The packet itself states its
      // version.
      if (packet.size() < kLoopbackHeader) return PacketResult::kTruncated;
      return udp.decode(packet.subspan(kLoopbackHeader), LinkLayer::kRawIp, frame);
    case DLT_LINUX_SLL:
      if (packet.size() < kCookedHeader) return PacketResult::kTruncated;
      return decode_cooked(packet, read_u16(packet, 14), kCookedHeader, udp, frame);
    case DLT_LINUX_SLL2:
      if (packet.size() < kCooked2Header) return PacketResult::kTruncated;
      return decode_cooked(packet, read_u16(packet, 0), kCooked2Header, udp, frame);
    case DLT_CAN_SOCKETCAN:
      return decode_socketcan(packet, std::endian::big, frame);
    default:
      return PacketResult::kUnsupported;
  }
}

}  // namespace boresight::recording
