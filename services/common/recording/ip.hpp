// Ethernet → IPv4 or IPv6 → UDP, with reassembly of fragments: radars send one large datagram in two dozen fragments.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "services/common/recording/frame.hpp"

namespace boresight::recording {

/// What came of one packet.
enum class PacketResult : std::uint8_t {
  kFrame,        ///< a whole UDP datagram is in the frame
  kIncomplete,   ///< a fragment; more are to come
  kIgnored,      ///< well-formed, but not UDP over IP
  kTruncated,    ///< a header or length reaches beyond the captured bytes
  kBadHeader,    ///< a header contradicts itself
  kFragmentLost  ///< the packet was taken, but an older datagram was given up incomplete
};

[[nodiscard]] std::string_view describe(PacketResult result);

/// Link layer of a capture.
enum class LinkLayer : std::uint8_t { kEthernet, kRawIp };

/// Decodes packets one after another. Memory is fixed: up to 16 datagrams are assembled at a time, the oldest gives
/// way. Fragments that overlap are dropped with their datagram.
class UdpDecoder {
 public:
  UdpDecoder();
  ~UdpDecoder();
  UdpDecoder(UdpDecoder&&) noexcept;
  UdpDecoder& operator=(UdpDecoder&&) noexcept;

  /// On kFrame, `frame` holds addresses, ports and payload; stamp_ns is left alone. The payload is valid until the
  /// next call and views either `packet` or the decoder's memory.
  [[nodiscard]] PacketResult decode(std::span<const std::uint8_t> packet, LinkLayer link, Frame& frame);

 private:
  struct Assembly;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace boresight::recording
