// Recorded frames on their way from the replay to the gateway: one record per message over a Unix socket of type
// SOCK_SEQPACKET. A slow gateway slows the replay down instead of losing frames. Little endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace boresight::wire::replay_tunnel {

inline constexpr std::uint32_t kMagic = 0x32525342;  // "BSR2"
inline constexpr std::size_t kMaxPayload = 65536;

/// Precedes the payload in each message. Both ends run on one machine, so the struct is sent as it is.
struct RecordHeader {
  std::uint32_t magic;
  std::uint8_t kind;      ///< 1 CAN, 2 CAN FD, 3 UDP
  std::uint8_t extended;  ///< CAN: 1 if the id has 29 bits
  std::uint8_t remote;    ///< CAN: 1 for a remote frame
  std::uint8_t reserved;
  std::int64_t stamp_ns;  ///< as recorded
  char interface[16];     ///< CAN: zero-terminated name
  std::uint32_t can_id;
  std::uint8_t source[16];  ///< UDP, IPv6 or mapped IPv4
  std::uint8_t destination[16];
  std::uint16_t source_port;
  std::uint16_t destination_port;
  std::uint32_t payload_bytes;
  std::uint32_t reserved2;
};
static_assert(sizeof(RecordHeader) == 80 && std::is_trivially_copyable_v<RecordHeader>);

}  // namespace boresight::wire::replay_tunnel
