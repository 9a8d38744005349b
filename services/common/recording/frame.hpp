// One frame of a bus or a network, as delivered by links, stored in recordings and sent through the replay tunnel.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "services/common/recording/ip_address.hpp"

namespace boresight::recording {

/// The last accepted second since the epoch, in 2255: a round number below those whose nanoseconds overflow. Readers of
/// all formats share it, so that every frame that one accepts can be written in the other formats.
inline constexpr std::int64_t kLastStamp_s = 9'000'000'000;

enum class FrameKind : std::uint8_t { kCan = 1, kCanFd = 2, kUdp = 3 };

/// A view: `payload` points into the reader's or the link's buffer and is valid until its next frame.
struct Frame {
  FrameKind kind = FrameKind::kCan;
  std::int64_t stamp_ns = 0;          ///< on the clock of the recording or link
  std::array<char, 16> interface {};  ///< CAN interface, zero-terminated; empty for UDP
  std::uint32_t can_id = 0;           ///< without flag bits
  bool can_extended = false;
  bool can_remote = false;
  std::uint8_t can_fd_flags = 0;  ///< CAN FD: bit 0 bit rate switch, bit 1 error state indicator
  Endpoint source;                ///< UDP
  Endpoint destination;
  std::span<const std::uint8_t> payload;

  [[nodiscard]] std::string_view interface_name() const {
    return {interface.data(),
            static_cast<std::size_t>(std::find(interface.begin(), interface.end(), '\0') - interface.begin())};
  }
  /// Cuts to 15 characters, the kernel's limit.
  void set_interface(std::string_view name) {
    interface.fill('\0');
    std::copy_n(name.data(), std::min(name.size(), interface.size() - 1), interface.data());
  }
};

}  // namespace boresight::recording
