// Ethernet → IPv4 or IPv6 → UDP, with reassembly of fragments: radars send one large datagram in two dozen fragments.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "services/common/recording/frame.hpp"

namespace boresight::recording {

/// Result of one packet.
enum class PacketResult : std::uint8_t {
  kFrame,         ///< the frame holds a complete UDP datagram, or a CAN frame
  kIncomplete,    ///< a fragment; others are missing
  kIgnored,       ///< well-formed, but not UDP over IP
  kTruncated,     ///< a header or length reaches beyond the captured bytes
  kBadHeader,     ///< a header is contradictory
  kFragmentLost,  ///< the packet was accepted, but an incomplete datagram was dropped
  kErrorFrame,    ///< a CAN error frame: a state of the bus, not data
  kUnsupported    ///< CAN XL
};

[[nodiscard]] std::string_view describe(PacketResult result);
/// True for results to be reported: the packet's content is lost.
[[nodiscard]] bool is_problem(PacketResult result);

/// Link layer of a capture.
enum class LinkLayer : std::uint8_t { kEthernet, kRawIp };

/// Decodes packets one after another. Memory is fixed: a megabyte, allocated at the first fragment, for up to 16
/// incomplete datagrams. A further datagram replaces the oldest one. A datagram is dropped if its fragments are more
/// than 30 s apart. A repeated fragment is ignored. If fragments contradict each other (they overlap, or reach beyond
/// the last one), the datagram is dropped and the newest fragment starts a new one: the sender may have used its
/// identification again.
class UdpDecoder {
 public:
  UdpDecoder();
  ~UdpDecoder();
  UdpDecoder(UdpDecoder&&) noexcept;
  UdpDecoder& operator=(UdpDecoder&&) noexcept;

  /// On kFrame, `frame` holds addresses, ports and payload. The caller sets frame.stamp_ns to the time of the packet
  /// before the call. The payload is valid until the next call and views either `packet` or the decoder's memory.
  [[nodiscard]] PacketResult decode(std::span<const std::uint8_t> packet, LinkLayer link, Frame& frame);

  /// Number of incomplete datagrams.
  [[nodiscard]] std::size_t unfinished() const;
  /// Number of dropped datagrams so far.
  [[nodiscard]] std::uint64_t given_up() const;

 private:
  struct Assembly;
  struct State;
  std::unique_ptr<State> state_;  // none before the first fragment
};

}  // namespace boresight::recording
