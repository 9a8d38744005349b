// Frames of linktype 227 (SocketCAN), as written by libpcap and Wireshark.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "services/common/recording/ip.hpp"

namespace boresight::recording {

/// The kernel's can_frame or canfd_frame. The id is big-endian in linktype 227. In Linux cooked captures it
/// has the byte order of the capturing machine. libpcap converts v1 to this machine's order; for v2 this order is
/// assumed. Results: kFrame (`frame` holds all values except stamp and interface), kErrorFrame, kTruncated, kBadHeader,
/// kUnsupported (CAN XL).
[[nodiscard]] PacketResult decode_socketcan(std::span<const std::uint8_t> packet, std::endian id_order, Frame& frame);

}  // namespace boresight::recording
