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
  kFrame,         ///< a whole UDP datagram, or a CAN frame, is in the frame
  kIncomplete,    ///< a fragment; more are to come
  kIgnored,       ///< well-formed, but not UDP over IP
  kTruncated,     ///< a header or length reaches beyond the captured bytes
  kBadHeader,     ///< a header contradicts itself
  kFragmentLost,  ///< the packet was taken, but a datagram was given up incomplete
  kErrorFrame,    ///< a CAN error frame: news of the bus, not data
  kUnsupported    ///< CAN XL
};

[[nodiscard]] std::string_view describe(PacketResult result);
/// Whether the packet is to be reported: what was in it is lost.
[[nodiscard]] bool is_problem(PacketResult result);

/// Link layer of a capture.
enum class LinkLayer : std::uint8_t { kEthernet, kRawIp };

/// Decodes packets one after another. Memory is fixed (a megabyte, taken at the first fragment): up to 16 datagrams are
/// assembled at a time, the oldest gives
/// way, as does one whose fragments are 30 s apart. A repeated fragment is ignored; where fragments contradict each
/// other (they overlap, or reach beyond the last one), what was assembled is given up and the newest begins anew, so
/// that a sender that uses an identification again is understood.
class UdpDecoder {
 public:
  UdpDecoder();
  ~UdpDecoder();
  UdpDecoder(UdpDecoder&&) noexcept;
  UdpDecoder& operator=(UdpDecoder&&) noexcept;

  /// On kFrame, `frame` holds addresses, ports and payload; stamp_ns is left alone, but is the time of the packet. The
  /// payload is valid until the next call and views either `packet` or the decoder's memory.
  [[nodiscard]] PacketResult decode(std::span<const std::uint8_t> packet, LinkLayer link, Frame& frame);

  /// Datagrams that lack fragments at the moment.
  [[nodiscard]] std::size_t unfinished() const;
  /// Datagrams that were given up so far.
  [[nodiscard]] std::uint64_t given_up() const;

 private:
  struct Assembly;
  struct State;
  std::unique_ptr<State> state_;  // none before the first fragment
};

}  // namespace boresight::recording
