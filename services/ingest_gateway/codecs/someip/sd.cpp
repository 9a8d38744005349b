#include "services/ingest_gateway/codecs/someip/sd.hpp"

#include "services/common/someip/big_endian.hpp"

namespace boresight::ingest::someip {

namespace {

constexpr std::size_t kFlagsBytes = 4;
constexpr std::size_t kLengthBytes = 4;
constexpr std::size_t kEntryBytes = 16;
// Length and type fields, which an option's length does not count; it counts the reserved byte after them.
constexpr std::size_t kOptionPrefixBytes = 3;
constexpr std::uint8_t kDiscardableBit = 0x80;
constexpr std::size_t kIpv4ContentBytes = 8;
constexpr std::size_t kIpv6ContentBytes = 20;
constexpr std::size_t kLoadBalancingBytes = 4;

/// Strings, each after its length; a length of 0 in the last byte ends them.
bool is_string_list(std::span<const std::uint8_t> content) {
  for (std::size_t at = 0; at < content.size(); at += 1u + content[at]) {
    if (content[at] == 0) return at + 1 == content.size();
  }
  return false;
}

bool read_ipv4(std::span<const std::uint8_t> content, SdOption& option) {
  if (content.size() != kIpv4ContentBytes) return false;
  option.endpoint = {recording::IpAddress::v4(read_u32(&content[0])), read_u16(&content[6])};
  option.protocol = content[5];
  return true;
}

bool read_ipv6(std::span<const std::uint8_t> content, SdOption& option) {
  if (content.size() != kIpv6ContentBytes) return false;
  option.endpoint = {recording::IpAddress::v6(content.first<16>()), read_u16(&content[18])};
  option.protocol = content[17];
  return true;
}

SdOption::State read_content(SdOption& option) {
  const auto judge = [](bool sound) { return sound ? SdOption::State::kSound : SdOption::State::kWrongContent; };
  switch (option.type) {
    case OptionType::kConfiguration:
      return judge(is_string_list(option.content));
    case OptionType::kLoadBalancing:
      if (option.content.size() != kLoadBalancingBytes) return SdOption::State::kWrongContent;
      option.priority = read_u16(&option.content[0]);
      option.weight = read_u16(&option.content[2]);
      return SdOption::State::kSound;
    case OptionType::kIpv4Endpoint:
    case OptionType::kIpv4Multicast:
    case OptionType::kIpv4SdEndpoint:
      return judge(read_ipv4(option.content, option));
    case OptionType::kIpv6Endpoint:
    case OptionType::kIpv6Multicast:
    case OptionType::kIpv6SdEndpoint:
      return judge(read_ipv6(option.content, option));
  }
  return SdOption::State::kUnknownType;
}

bool is_usable(const recording::Endpoint& endpoint, SdMessage::Family family, SdMessage::Purpose purpose) {
  const recording::IpAddress& address = endpoint.address;
  if (endpoint.port == 0 || address.is_unspecified()) return false;
  // An IPv4 address in an IPv6 option is not reachable over IPv6.
  if (address.is_v4() != (family == SdMessage::Family::kIpv4)) return false;
  if (purpose == SdMessage::Purpose::kMulticast) return address.is_multicast();
  return !address.is_multicast() && address.to_v4() != 0xFFFFFFFF;
}

}  // namespace

std::string_view describe(SdFault fault) {
  switch (fault) {
    case SdFault::kNone:
      return "";
    case SdFault::kHeader:
      return "SOME/IP-SD: header is not that of a notification ffff/8100, interface version 1, return code 0";
    case SdFault::kTooShort:
      return "SOME/IP-SD: shorter than flags and two lengths (12 bytes)";
    case SdFault::kEntriesLength:
      return "SOME/IP-SD: length of entries array is not a multiple of 16, or beyond the message";
    case SdFault::kOptionsLength:
      return "SOME/IP-SD: options array does not end at the message's end";
    case SdFault::kOptionLength:
      return "SOME/IP-SD: length of an option is 0 or reaches beyond the options array";
    case SdFault::kTooManyEntries:
      return "SOME/IP-SD: more than 64 entries";
    case SdFault::kTooManyOptions:
      return "SOME/IP-SD: more than 64 options";
    case SdFault::kEntryType:
      return "SOME/IP-SD: unknown type of entry";
    case SdFault::kFirstRun:
      return "SOME/IP-SD: index and number of an entry's first options reach beyond the options";
    case SdFault::kSecondRun:
      return "SOME/IP-SD: index and number of an entry's second options reach beyond the options";
    case SdFault::kOptionContent:
      return "SOME/IP-SD: length of an option does not fit its type";
    case SdFault::kOptionUnknown:
      return "SOME/IP-SD: an entry needs an option of unknown type";
    case SdFault::kEndpointConflict:
      return "SOME/IP-SD: an entry states two different UDP endpoints";
    case SdFault::kEndpointAddress:
      return "SOME/IP-SD: address or port of an endpoint option is invalid for its kind";
    case SdFault::kEndpointMissing:
      return "SOME/IP-SD: an entry states no UDP endpoint of the interface's address family";
  }
  return "SOME/IP-SD: unknown fault";
}

SdFault SdMessage::read_options(std::span<const std::uint8_t> bytes) {
  number_of_options_ = 0;
  while (!bytes.empty()) {
    if (number_of_options_ == kMaxOptions) return SdFault::kTooManyOptions;
    if (bytes.size() < kOptionPrefixBytes) return SdFault::kOptionLength;
    const std::size_t length = read_u16(bytes.data());
    if (length == 0 || length > bytes.size() - kOptionPrefixBytes) return SdFault::kOptionLength;
    SdOption& option = options_[number_of_options_++];
    option = {};
    option.type = static_cast<OptionType>(bytes[2]);
    option.discardable = (bytes[3] & kDiscardableBit) != 0;
    option.content = bytes.subspan(kOptionPrefixBytes + 1, length - 1);
    option.state = read_content(option);
    bytes = bytes.subspan(kOptionPrefixBytes + length);
  }
  return SdFault::kNone;
}

SdFault SdMessage::judge_runs(const SdEntry& entry) const {
  for (std::size_t which = 0; which < 2; ++which) {
    // The index of an empty run is not used.
    if (entry.run_length[which] == 0) continue;
    if (std::size_t{entry.run_index[which]} + entry.run_length[which] > number_of_options_) {
      return which == 0 ? SdFault::kFirstRun : SdFault::kSecondRun;
    }
    for (const SdOption& option : run(entry, which)) {
      if (option.state == SdOption::State::kWrongContent) return SdFault::kOptionContent;
      if (option.state == SdOption::State::kUnknownType && !option.discardable) return SdFault::kOptionUnknown;
    }
  }
  return SdFault::kNone;
}

void SdMessage::read_entry(const std::uint8_t* bytes, SdEntry& entry) const {
  entry = {};
  entry.type = static_cast<EntryType>(bytes[0]);
  entry.run_index = {bytes[1], bytes[2]};
  entry.run_length = {static_cast<std::uint8_t>(bytes[3] >> 4), static_cast<std::uint8_t>(bytes[3] & 0x0F)};
  for (std::size_t which = 0; which < 2; ++which) {
    if (entry.run_length[which] == 0) entry.run_index[which] = 0;
  }
  entry.service = read_u16(bytes + 4);
  entry.instance = read_u16(bytes + 6);
  entry.major = bytes[8];
  entry.ttl_s = read_u24(bytes + 9);
  switch (entry.type) {
    case EntryType::kFind:
    case EntryType::kOffer:
      entry.minor = read_u32(bytes + 12);
      break;
    case EntryType::kSubscribe:
    case EntryType::kSubscribeAck:
      entry.counter = bytes[13] & 0x0F;
      entry.eventgroup = read_u16(bytes + 14);
      break;
    default:
      entry.fault = SdFault::kEntryType;
      return;
  }
  entry.fault = judge_runs(entry);
}

SdFault SdMessage::read(const Message& message) {
  number_of_entries_ = number_of_options_ = 0;
  if (message.service != kSdService || message.method != kSdMethod || message.type != MessageType::kNotification ||
      message.tp || message.interface_version != 1 || message.return_code != 0) {
    return SdFault::kHeader;
  }
  std::span<const std::uint8_t> rest = message.payload;
  if (rest.size() < kFlagsBytes + 2 * kLengthBytes) return SdFault::kTooShort;
  flags_ = rest[0];
  const std::size_t entries_bytes = read_u32(&rest[kFlagsBytes]);
  rest = rest.subspan(kFlagsBytes + kLengthBytes);
  if (entries_bytes % kEntryBytes != 0 || entries_bytes > rest.size() - kLengthBytes) return SdFault::kEntriesLength;
  if (entries_bytes / kEntryBytes > kMaxEntries) return SdFault::kTooManyEntries;
  const std::span<const std::uint8_t> entries = rest.first(entries_bytes);
  rest = rest.subspan(entries_bytes);
  const std::size_t options_bytes = read_u32(rest.data());
  rest = rest.subspan(kLengthBytes);
  if (options_bytes != rest.size()) return SdFault::kOptionsLength;
  if (const SdFault fault = read_options(rest); fault != SdFault::kNone) {
    number_of_options_ = 0;
    return fault;
  }
  for (std::size_t at = 0; at < entries.size(); at += kEntryBytes) {
    read_entry(&entries[at], entries_[number_of_entries_++]);
  }
  return SdFault::kNone;
}

SdFault SdMessage::endpoint_of(const SdEntry& entry, Family family, Purpose purpose,
                               recording::Endpoint& endpoint) const {
  OptionType wanted = family == Family::kIpv4 ? OptionType::kIpv4Endpoint : OptionType::kIpv6Endpoint;
  if (purpose == Purpose::kMulticast) {
    wanted = family == Family::kIpv4 ? OptionType::kIpv4Multicast : OptionType::kIpv6Multicast;
  }
  bool found = false;
  for (std::size_t which = 0; which < 2; ++which) {
    for (const SdOption& option : run(entry, which)) {
      if (option.state != SdOption::State::kSound || option.type != wanted || option.protocol != kUdp) continue;
      if (!is_usable(option.endpoint, family, purpose)) return SdFault::kEndpointAddress;
      if (found && option.endpoint != endpoint) return SdFault::kEndpointConflict;
      endpoint = option.endpoint;
      found = true;
    }
  }
  return found ? SdFault::kNone : SdFault::kEndpointMissing;
}

SdFault SdMessage::sd_endpoint(Family family, recording::Endpoint& endpoint) const {
  const OptionType wanted = family == Family::kIpv4 ? OptionType::kIpv4SdEndpoint : OptionType::kIpv6SdEndpoint;
  for (const SdOption& option : options()) {
    if (option.type != wanted) continue;
    if (option.state != SdOption::State::kSound) return SdFault::kOptionContent;
    if (option.protocol != kUdp || !is_usable(option.endpoint, family, Purpose::kUnicast)) {
      return SdFault::kEndpointAddress;
    }
    endpoint = option.endpoint;
    return SdFault::kNone;
  }
  return SdFault::kEndpointMissing;
}

}  // namespace boresight::ingest::someip
