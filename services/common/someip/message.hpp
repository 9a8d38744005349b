// SOME/IP messages of a datagram, looked at in place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace boresight::someip {

inline constexpr std::size_t kHeaderBytes = 16;
/// What the length field counts besides the payload: Request ID, versions, type and return code.
inline constexpr std::size_t kLengthCountsBytes = 8;
inline constexpr std::uint8_t kProtocolVersion = 1;
inline constexpr std::uint8_t kTpBit = 0x20;

enum class MessageType : std::uint8_t {
  kRequest = 0x00,
  kRequestNoReturn = 0x01,
  kNotification = 0x02,
  kResponse = 0x80,
  kError = 0x81,
};

/// One message; the spans point into the datagram (or the reassembly buffer) it was read from.
struct Message {
  std::uint16_t service = 0;
  std::uint16_t method = 0;  ///< of an event: its id, 0x8000 … 0xFFFE
  std::uint16_t client = 0;
  std::uint16_t session = 0;
  std::uint8_t protocol_version = 0;
  std::uint8_t interface_version = 0;
  MessageType type = MessageType::kNotification;  ///< without the TP bit
  bool tp = false;                                ///< a segment: payload begins with the TP header
  std::uint8_t return_code = 0;
  std::span<const std::uint8_t> payload;
  /// From the Request ID to the end: what E2E protection covers.
  std::span<const std::uint8_t> protected_data;
};

enum class ReadResult : std::uint8_t {
  kMessage,          ///< the message is sound
  kEnd,              ///< nothing is left of the datagram
  kHeaderCut,        ///< fewer bytes than a header are left: the rest is given up
  kLengthTooSmall,   ///< the length field does not even count the header's second half: the rest is given up
  kBeyondDatagram,   ///< the length field reaches beyond the datagram: the rest is given up
  kProtocolVersion,  ///< not protocol version 1: this message is skipped
  kMessageType,      ///< a message type that does not exist: this message is skipped
};
/// What is wrong and what is allowed, for a fault; "" for kMessage and kEnd.
[[nodiscard]] std::string_view describe(ReadResult result);

/// Goes through the messages of one UDP datagram ("nPDU": several may share one). Messages before a bad one are
/// delivered. After a message whose length cannot be right nothing says where the next begins, so that next() returns
/// its fault once and then kEnd.
class MessageReader {
 public:
  explicit MessageReader(std::span<const std::uint8_t> datagram) : rest_(datagram), at_end_(false) {}

  /// Writes `message` if the result is kMessage, and also if it is one of those that skip a message, so that it can be
  /// answered. An empty datagram is a fault (kHeaderCut).
  [[nodiscard]] ReadResult next(Message& message);

 private:
  [[nodiscard]] ReadResult give_up(ReadResult reason);
  std::span<const std::uint8_t> rest_;
  bool at_end_;
};

/// Bytes of a message's header before its payload; `payload_bytes` below 2^32 − 8.
void write_header(const Message& message, std::size_t payload_bytes, std::span<std::uint8_t, kHeaderBytes> out);

}  // namespace boresight::someip
