// SOME/IP messages of a datagram, read in place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace boresight::someip {

inline constexpr std::size_t kHeaderBytes = 16;
/// Bytes that the length field counts besides the payload: Request ID, versions, type and return code.
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

/// One message; the spans point into its datagram or reassembly buffer.
struct Message {
  std::uint16_t service = 0;
  std::uint16_t method = 0;  ///< of an event: its id, 0x8000 … 0xFFFE
  std::uint16_t client = 0;
  std::uint16_t session = 0;
  std::uint8_t protocol_version = 0;
  std::uint8_t interface_version = 0;
  MessageType type = MessageType::kNotification;  ///< without the TP bit
  bool tp = false;                                ///< a segment, whose payload begins with the TP header
  std::uint8_t return_code = 0;
  std::span<const std::uint8_t> payload;
  /// From the Request ID to the end: the data that E2E protection covers.
  std::span<const std::uint8_t> protected_data;
};

enum class ReadResult : std::uint8_t {
  kMessage,          ///< a valid message
  kEnd,              ///< end of the datagram
  kHeaderCut,        ///< fewer bytes than a header are left; the rest is dropped
  kLengthTooSmall,   ///< length field below 8, the header's second half; the rest is dropped
  kBeyondDatagram,   ///< the length field reaches beyond the datagram; the rest is dropped
  kProtocolVersion,  ///< not protocol version 1; this message is skipped
  kMessageType,      ///< a message type that does not exist; this message is skipped
};
/// Description of a fault with the allowed value; "" for kMessage and kEnd.
[[nodiscard]] std::string_view describe(ReadResult result);

/// Reads the messages of one UDP datagram, which may hold several ("nPDU"). Messages before a faulty one are delivered.
/// After a message with a wrong length the begin of the next one is unknown: next() returns the fault once, then kEnd.
class MessageReader {
 public:
  explicit MessageReader(std::span<const std::uint8_t> datagram) : rest_(datagram), at_end_(false) {}

  /// Writes `message` if the result is kMessage, and also for results that skip a message, so that the caller can
  /// answer the message. An empty datagram is a fault (kHeaderCut).
  [[nodiscard]] ReadResult next(Message& message);

 private:
  [[nodiscard]] ReadResult give_up(ReadResult reason);
  std::span<const std::uint8_t> rest_;
  bool at_end_;
};

/// Bytes of a message's header before its payload; `payload_bytes` below 2^32 − 8.
void write_header(const Message& message, std::size_t payload_bytes, std::span<std::uint8_t, kHeaderBytes> out);

}  // namespace boresight::someip
