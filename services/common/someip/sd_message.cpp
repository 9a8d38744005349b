#include "services/common/someip/sd_message.hpp"

#include <algorithm>

#include "services/common/someip/byte_writer.hpp"

namespace boresight::someip {

namespace {

constexpr std::size_t kEntryBytes = 16;
constexpr std::size_t kSomeIpHeaderBytes = 16;
constexpr std::uint8_t kUdp = 17;
constexpr std::uint8_t kEndpointV4 = 0x04, kEndpointV6 = 0x06, kMulticastV4 = 0x14, kMulticastV6 = 0x16;

/// Takes big-endian values from the front of a span; 0 at its end.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint32_t take(std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | (at_ + i < bytes_.size() ? bytes_[at_ + i] : 0u);
    at_ += count;
    return value;
  }
  std::uint8_t u8() { return static_cast<std::uint8_t>(take(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(take(2)); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// The length in front of an array of `bytes`, and the array; nothing if it does not fit.
std::optional<std::span<const std::uint8_t>> counted_array(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 4) return std::nullopt;
  const std::size_t length = ByteReader(bytes).take(4);
  if (length > bytes.size() - 4) return std::nullopt;
  return bytes.subspan(4, length);
}

/// Endpoint of a UDP endpoint option that events can be sent to; nothing for all other options.
std::optional<recording::Endpoint> usable_endpoint(std::uint8_t type, std::span<const std::uint8_t> content) {
  // Content: reserved u8, address, reserved u8, protocol u8, port u16.
  const std::size_t address_bytes = type == kEndpointV4 ? 4 : 16;
  if ((type != kEndpointV4 && type != kEndpointV6) || content.size() != address_bytes + 5) return std::nullopt;
  recording::Endpoint endpoint;
  ByteReader tail(content.subspan(1 + address_bytes + 1));
  if (tail.u8() != kUdp) return std::nullopt;
  endpoint.port = tail.u16();
  if (type == kEndpointV4) {
    endpoint.address = recording::IpAddress::v4(ByteReader(content.subspan(1)).take(4));
  } else {
    endpoint.address = recording::IpAddress::v6(content.subspan<1, 16>());
  }
  if (endpoint.port == 0 || endpoint.address.is_unspecified() || endpoint.address.is_multicast()) return std::nullopt;
  return endpoint;
}

struct Options {
  std::array<std::optional<recording::Endpoint>, SdMessage::kMaxOptions> endpoints{};
  std::size_t count = 0;
};

bool read_options(std::span<const std::uint8_t> bytes, Options& options) {
  while (!bytes.empty()) {
    constexpr std::size_t kLengthAndType = 3;
    if (bytes.size() < kLengthAndType || options.count == options.endpoints.size()) return false;
    ByteReader head(bytes);
    const std::size_t length = head.u16();
    const std::uint8_t type = head.u8();
    if (length > bytes.size() - kLengthAndType) return false;
    options.endpoints[options.count++] = usable_endpoint(type, bytes.subspan(kLengthAndType, length));
    bytes = bytes.subspan(kLengthAndType + length);
  }
  return true;
}

/// False if the entry refers to missing options.
bool read_entry(std::span<const std::uint8_t> bytes, const Options& options, SdEntry& entry) {
  ByteReader reader(bytes);
  entry = SdEntry{};
  entry.type = reader.u8();
  const std::array<std::size_t, 2> first{reader.u8(), reader.u8()};
  const std::uint8_t counts = reader.u8();
  const std::array<std::size_t, 2> count{static_cast<std::size_t>(counts >> 4), counts & 0x0Fu};
  entry.service = reader.u16();
  entry.instance = reader.u16();
  entry.major = reader.u8();
  entry.ttl_s = reader.take(3);
  // The last four bytes are the minor version, or reserved bits, counter and eventgroup.
  entry.minor = reader.take(4);
  entry.counter = static_cast<std::uint8_t>(entry.minor >> 16 & 0x0Fu);
  entry.eventgroup = static_cast<std::uint16_t>(entry.minor);
  for (std::size_t run = 0; run < 2; ++run) {
    if (count[run] == 0) continue;
    if (first[run] + count[run] > options.count) return false;
    for (std::size_t i = first[run]; i < first[run] + count[run]; ++i) {
      if (!entry.endpoint) entry.endpoint = options.endpoints[i];
    }
  }
  return true;
}

}  // namespace

std::optional<std::string_view> read_sd(std::span<const std::uint8_t> message, SdMessage& out) {
  constexpr std::size_t kFlagsBytes = 4;
  out.number_of_entries = 0;
  if (message.size() < kSomeIpHeaderBytes + kFlagsBytes) return "SD message is too short";
  ByteReader header(message);
  if (header.take(4) != 0xFFFF8100) return "not an SD message";
  if (header.take(4) != message.size() - 8) return "SD message: length field differs from the message's length";
  static_cast<void>(header.u16());
  out.session = header.u16();
  if (header.take(4) != 0x01010200) return "SD message: version, type or return code is wrong";
  if (out.session == 0) return "SD message: session id 0";
  out.reboot = (header.u8() & 0x80) != 0;

  const auto entries = counted_array(message.subspan(kSomeIpHeaderBytes + kFlagsBytes));
  if (!entries || entries->size() % kEntryBytes != 0) return "SD message: length of entries is wrong";
  if (entries->size() / kEntryBytes > SdMessage::kMaxEntries) return "SD message: more than 64 entries";
  const auto options = counted_array(message.subspan(kSomeIpHeaderBytes + kFlagsBytes + 4 + entries->size()));
  if (!options) return "SD message: length of options is wrong";
  Options read;
  if (!read_options(*options, read)) return "SD message: options are truncated or more than 64";
  const std::size_t count = entries->size() / kEntryBytes;
  for (std::size_t i = 0; i < count; ++i) {
    if (!read_entry(entries->subspan(i * kEntryBytes, kEntryBytes), read, out.entries[i])) {
      return "SD message: an entry refers to missing options";
    }
  }
  out.number_of_entries = count;
  return std::nullopt;
}

std::uint8_t SdWriter::option(std::uint8_t type_v4, std::uint8_t type_v6, const recording::Endpoint& endpoint) {
  const bool v4 = endpoint.address.is_v4();
  const std::span<const std::uint8_t> address =
      std::span<const std::uint8_t>(endpoint.address.bytes).subspan(v4 ? 12 : 0);
  std::vector<std::uint8_t> bytes(3 + 1 + address.size() + 4);
  ByteWriter writer(bytes);
  writer.u16(static_cast<std::uint16_t>(bytes.size() - 3));
  writer.u8(v4 ? type_v4 : type_v6);
  writer.u8(0);
  writer.bytes(address);
  writer.u8(0);
  writer.u8(kUdp);
  writer.u16(endpoint.port);
  const auto same = std::find(options_.begin(), options_.end(), bytes);
  const auto index = static_cast<std::uint8_t>(same - options_.begin());
  if (same == options_.end()) options_.push_back(std::move(bytes));
  return index;
}

void SdWriter::offer(const Service& service, std::uint32_t ttl_s, const recording::Endpoint& endpoint) {
  const std::uint8_t index = option(kEndpointV4, kEndpointV6, endpoint);
  std::array<std::uint8_t, kEntryBytes> entry{};
  ByteWriter writer(entry);
  writer.u8(static_cast<std::uint8_t>(SdEntryType::kOfferService));
  writer.u8(index);
  writer.u8(0);
  writer.u8(0x10);
  writer.u16(service.service);
  writer.u16(service.instance);
  writer.u8(service.major);
  writer.u24(ttl_s);
  writer.u32(service.minor);
  entries_.insert(entries_.end(), entry.begin(), entry.end());
}

void SdWriter::acknowledge(const SdEntry& subscription, std::uint32_t ttl_s,
                           const std::optional<recording::Endpoint>& group) {
  const std::uint8_t index = group ? option(kMulticastV4, kMulticastV6, *group) : std::uint8_t{0};
  std::array<std::uint8_t, kEntryBytes> entry{};
  ByteWriter writer(entry);
  writer.u8(static_cast<std::uint8_t>(SdEntryType::kSubscribeEventgroupAck));
  writer.u8(index);
  writer.u8(0);
  writer.u8(group ? 0x10 : 0x00);
  writer.u16(subscription.service);
  writer.u16(subscription.instance);
  writer.u8(subscription.major);
  writer.u24(ttl_s);
  writer.u16(subscription.counter);
  writer.u16(subscription.eventgroup);
  entries_.insert(entries_.end(), entry.begin(), entry.end());
}

std::vector<std::uint8_t> SdWriter::finish(std::uint16_t session, bool reboot) const {
  std::size_t options_bytes = 0;
  for (const auto& option : options_) options_bytes += option.size();
  std::vector<std::uint8_t> message(kSomeIpHeaderBytes + 4 + 4 + entries_.size() + 4 + options_bytes);
  ByteWriter writer(message);
  writer.u32(0xFFFF8100);
  writer.u32(static_cast<std::uint32_t>(message.size() - 8));
  writer.u16(0);
  writer.u16(session);
  writer.u32(0x01010200);
  writer.u8(reboot ? 0xC0 : 0x40);
  writer.zeros(3);
  writer.u32(static_cast<std::uint32_t>(entries_.size()));
  writer.bytes(entries_);
  writer.u32(static_cast<std::uint32_t>(options_bytes));
  for (const auto& option : options_) writer.bytes(option);
  return message;
}

}  // namespace boresight::someip
