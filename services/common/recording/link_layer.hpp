// Link layers of captures: extracts CAN frames and IP packets.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "services/common/recording/ip.hpp"

namespace boresight::recording {

/// True if captures with that link type (libpcap's DLT_…) can be decoded.
[[nodiscard]] bool is_supported_link(int link_type);
/// libpcap's DLT_… of a file's link type; the two differ for raw IP and the BSD loopback.
[[nodiscard]] int data_link_of(std::uint16_t link_type);
/// For error texts: "Ethernet, raw IP, …".
[[nodiscard]] std::string_view supported_links();

/// Decodes one packet: a CAN frame, or a UDP datagram with reassembly in `udp`. `frame` gets all values except stamp
/// and interface.
[[nodiscard]] PacketResult decode_packet(std::span<const std::uint8_t> packet, int link_type, UdpDecoder& udp,
                                         Frame& frame);

}  // namespace boresight::recording
