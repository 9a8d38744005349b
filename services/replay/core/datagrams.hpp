// Messages → datagrams: segments long messages (SOME/IP-TP) and combines short ones
// (interfaces/wire/boresight_service.md, 2.3).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/someip/byte_writer.hpp"

namespace boresight::replay {

inline constexpr std::size_t kMaxDatagramBytes =
    wire::boresight_service::kSomeIpHeaderBytes + wire::boresight_service::kMaxUnsegmentedPayloadBytes;

/// True if the message is sent unsegmented.
[[nodiscard]] inline bool fits_one_datagram(std::span<const std::uint8_t> message) {
  return message.size() <= kMaxDatagramBytes;
}

/// Calls `send(std::span<const std::uint8_t> datagram)` for the message, or for each of its segments in order.
/// `message` is a complete SOME/IP message with its header.
template <typename Send>
void for_each_datagram(std::span<const std::uint8_t> message, Send&& send) {
  namespace service = wire::boresight_service;
  if (fits_one_datagram(message)) {
    send(message);
    return;
  }
  constexpr std::size_t kTpHeaderBytes = 4;
  constexpr std::size_t kMessageType = 14;
  constexpr std::uint8_t kTpFlag = 0x20;
  static_assert(service::kSegmentBytes % 16 == 0);
  const std::span<const std::uint8_t> payload = message.subspan(service::kSomeIpHeaderBytes);
  std::array<std::uint8_t, service::kSomeIpHeaderBytes + kTpHeaderBytes + service::kSegmentBytes> segment{};
  for (std::size_t at = 0; at < payload.size(); at += service::kSegmentBytes) {
    const std::span<const std::uint8_t> part =
        payload.subspan(at, std::min(service::kSegmentBytes, payload.size() - at));
    const bool more = at + part.size() < payload.size();
    someip::ByteWriter writer(segment);
    writer.bytes(message.first(4));
    writer.u32(static_cast<std::uint32_t>(8 + kTpHeaderBytes + part.size()));
    writer.bytes(message.subspan(8, kMessageType - 8));
    writer.u8(message[kMessageType] | kTpFlag);
    writer.u8(message[kMessageType + 1]);
    writer.u32(static_cast<std::uint32_t>(at) | (more ? 1u : 0u));
    writer.bytes(part);
    send(std::span<const std::uint8_t>(segment).first(writer.size()));
  }
}

/// Combines several unsegmented messages for one receiver in one datagram.
class SharedDatagram {
 public:
  /// False without any change if the message does not fit.
  [[nodiscard]] bool add(std::span<const std::uint8_t> message) {
    if (size_ + message.size() > bytes_.size()) return false;
    std::copy(message.begin(), message.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += message.size();
    return true;
  }
  [[nodiscard]] std::span<const std::uint8_t> content() const { return std::span(bytes_).first(size_); }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }

 private:
  std::array<std::uint8_t, kMaxDatagramBytes> bytes_{};
  std::size_t size_ = 0;
};

}  // namespace boresight::replay
