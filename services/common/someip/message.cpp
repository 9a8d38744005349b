#include "services/common/someip/message.hpp"

#include "services/common/someip/big_endian.hpp"

namespace boresight::someip {

namespace {

bool is_known(std::uint8_t type) {
  switch (static_cast<MessageType>(type)) {
    case MessageType::kRequest:
    case MessageType::kRequestNoReturn:
    case MessageType::kNotification:
    case MessageType::kResponse:
    case MessageType::kError:
      return true;
  }
  return false;
}

}  // namespace

std::string_view describe(ReadResult result) {
  switch (result) {
    case ReadResult::kMessage:
    case ReadResult::kEnd:
      return "";
    case ReadResult::kHeaderCut:
      return "SOME/IP: fewer than the 16 bytes of a header";
    case ReadResult::kLengthTooSmall:
      return "SOME/IP: length field below 8";
    case ReadResult::kBeyondDatagram:
      return "SOME/IP: length field reaches beyond the datagram";
    case ReadResult::kProtocolVersion:
      return "SOME/IP: protocol version is not 1";
    case ReadResult::kMessageType:
      return "SOME/IP: unknown message type";
  }
  return "SOME/IP: unknown fault";
}

ReadResult MessageReader::give_up(ReadResult reason) {
  at_end_ = true;
  return reason;
}

ReadResult MessageReader::next(Message& message) {
  if (at_end_) return ReadResult::kEnd;
  if (rest_.size() < kHeaderBytes) return give_up(ReadResult::kHeaderCut);
  const std::uint8_t* const bytes = rest_.data();
  const std::size_t length = read_u32(bytes + 4);
  if (length < kLengthCountsBytes) return give_up(ReadResult::kLengthTooSmall);
  if (length > rest_.size() - 8) return give_up(ReadResult::kBeyondDatagram);
  const std::span<const std::uint8_t> counted = rest_.subspan(8, length);
  rest_ = rest_.subspan(8 + length);
  at_end_ = rest_.empty();
  const auto plain_type = static_cast<std::uint8_t>(bytes[14] & ~kTpBit);
  message.service = read_u16(bytes);
  message.method = read_u16(bytes + 2);
  message.client = read_u16(bytes + 8);
  message.session = read_u16(bytes + 10);
  message.protocol_version = bytes[12];
  message.interface_version = bytes[13];
  message.type = static_cast<MessageType>(plain_type);
  message.tp = (bytes[14] & kTpBit) != 0;
  message.return_code = bytes[15];
  message.payload = counted.subspan(kLengthCountsBytes);
  message.protected_data = counted;
  if (bytes[12] != kProtocolVersion) return ReadResult::kProtocolVersion;
  return is_known(plain_type) ? ReadResult::kMessage : ReadResult::kMessageType;
}

void write_header(const Message& message, std::size_t payload_bytes, std::span<std::uint8_t, kHeaderBytes> out) {
  write_u16(&out[0], message.service);
  write_u16(&out[2], message.method);
  write_u32(&out[4], static_cast<std::uint32_t>(payload_bytes + kLengthCountsBytes));
  write_u16(&out[8], message.client);
  write_u16(&out[10], message.session);
  out[12] = message.protocol_version;
  out[13] = message.interface_version;
  out[14] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(message.type) | (message.tp ? kTpBit : 0));
  out[15] = message.return_code;
}

}  // namespace boresight::someip
