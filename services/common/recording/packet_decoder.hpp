// Common part of the readers of captures: decodes a packet with its stamp to a frame, or counts and reports it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "services/common/recording/ip.hpp"
#include "services/common/recording/reader.hpp"

namespace boresight::recording {

/// The interface at which a packet was captured.
struct CaptureInterface {
  int link_type = 0;     ///< libpcap's DLT_…
  std::string can_name;  ///< for CAN frames
  UdpDecoder udp;        ///< one per interface, as two interfaces may have captured the same fragments
  std::uint64_t given_up = 0;
};

class PacketDecoder {
 public:
  PacketDecoder(std::string file, OnProblem on_problem) : file_(std::move(file)), on_problem_(std::move(on_problem)) {}

  /// The next packet begins; problems refer to this packet.
  void begin_packet() { ++number_; }
  /// True if `frame` is complete. `original_size` is the size on the wire.
  [[nodiscard]] bool take(CaptureInterface& interface, std::int64_t seconds, std::int64_t nanoseconds,
                          std::span<const std::uint8_t> packet, std::size_t original_size, Frame& frame);
  /// The interface's capture has ended; reports incomplete datagrams.
  void end(const CaptureInterface& interface);
  void problem(std::string_view text);
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  std::string file_;
  OnProblem on_problem_;
  std::uint64_t number_ = 0;
  std::int64_t last_stamp_ns_ = 0;
  Counts counts_;
};

}  // namespace boresight::recording
