// Frames of linktype 227 (SocketCAN), as libpcap and Wireshark write them.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "services/common/recording/ip.hpp"

namespace boresight::recording {

/// The kernel's can_frame or canfd_frame. The id is big-endian in linktype 227; in Linux cooked captures it is as the
/// capturing machine had it, which libpcap turns into this machine's order (v1; v2 is taken to be of such a machine).
/// Results: kFrame (`frame` holds all but stamp and interface), kErrorFrame, kTruncated, kBadHeader, kUnsupported (CAN
/// XL).
[[nodiscard]] PacketResult decode_socketcan(std::span<const std::uint8_t> packet, std::endian id_order, Frame& frame);

}  // namespace boresight::recording
