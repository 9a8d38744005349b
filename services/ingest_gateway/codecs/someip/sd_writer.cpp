#include "services/ingest_gateway/codecs/someip/sd_writer.hpp"

#include <algorithm>

#include "services/common/someip/big_endian.hpp"

namespace boresight::ingest::someip {

namespace {

constexpr std::uint16_t kIpv4OptionLength = 9;
constexpr std::uint16_t kIpv6OptionLength = 21;
constexpr std::uint8_t kOneOptionInFirstRun = 0x10;

/// Returns the offset after the last written byte.
std::uint8_t* write_option(const recording::Endpoint& endpoint, std::uint8_t* out) {
  const bool ipv4 = endpoint.address.is_v4();
  write_u16(out, ipv4 ? kIpv4OptionLength : kIpv6OptionLength);
  out[2] = static_cast<std::uint8_t>(ipv4 ? OptionType::kIpv4Endpoint : OptionType::kIpv6Endpoint);
  out[3] = 0;
  out += 4;
  const std::span<const std::uint8_t> address = std::span(endpoint.address.bytes).subspan(ipv4 ? 12 : 0);
  out = std::copy(address.begin(), address.end(), out);
  out[0] = 0;
  out[1] = kUdp;
  write_u16(out + 2, endpoint.port);
  return out + 4;
}

}  // namespace

bool SdWriter::add_option(const recording::Endpoint& endpoint, std::uint8_t& index) {
  const auto end = options_.begin() + static_cast<std::ptrdiff_t>(number_of_options_);
  const auto found = std::find(options_.begin(), end, endpoint);
  if (found == end) {
    if (number_of_options_ == kMaxOptions) return false;
    *found = endpoint;
    ++number_of_options_;
  }
  index = static_cast<std::uint8_t>(found - options_.begin());
  return true;
}

bool SdWriter::find(std::uint16_t service, std::uint16_t instance, std::uint8_t major) {
  if (number_of_entries_ == kMaxEntries) return false;
  auto& entry = entries_[number_of_entries_++];
  entry = {static_cast<std::uint8_t>(EntryType::kFind)};
  write_u16(&entry[4], service);
  write_u16(&entry[6], instance);
  entry[8] = major;
  write_u24(&entry[9], kForever_s);
  write_u32(&entry[12], kAnyMinor);
  return true;
}

bool SdWriter::subscribe(const EventgroupId& id, std::uint32_t ttl_s, const recording::Endpoint& local) {
  std::uint8_t option_index = 0;
  if (number_of_entries_ == kMaxEntries || !add_option(local, option_index)) return false;
  auto& entry = entries_[number_of_entries_++];
  entry = {static_cast<std::uint8_t>(EntryType::kSubscribe), option_index, 0, kOneOptionInFirstRun};
  write_u16(&entry[4], id.service);
  write_u16(&entry[6], id.instance);
  entry[8] = id.major;
  write_u24(&entry[9], ttl_s);
  entry[13] = id.counter & 0x0F;
  write_u16(&entry[14], id.eventgroup);
  return true;
}

bool SdWriter::stop_subscribe(const EventgroupId& id, const recording::Endpoint& local) {
  return subscribe(id, 0, local);
}

std::span<const std::uint8_t> SdWriter::finish(std::uint16_t session, bool reboot_flag) {
  std::uint8_t* const payload = &datagram_[kHeaderBytes];
  payload[0] = static_cast<std::uint8_t>(kUnicastFlag | (reboot_flag ? kRebootFlag : 0));
  payload[1] = payload[2] = payload[3] = 0;
  write_u32(payload + 4, static_cast<std::uint32_t>(number_of_entries_ * kEntryBytes));
  std::uint8_t* out = payload + 8;
  for (std::size_t i = 0; i < number_of_entries_; ++i) out = std::copy(entries_[i].begin(), entries_[i].end(), out);
  std::uint8_t* const options_length = out;
  out += 4;
  for (std::size_t i = 0; i < number_of_options_; ++i) out = write_option(options_[i], out);
  write_u32(options_length, static_cast<std::uint32_t>(out - options_length - 4));

  Message header;
  header.service = kSdService;
  header.method = kSdMethod;
  header.session = session;
  header.protocol_version = kProtocolVersion;
  header.interface_version = 1;
  const auto payload_bytes = static_cast<std::size_t>(out - payload);
  write_header(header, payload_bytes, std::span(datagram_).first<kHeaderBytes>());
  return std::span(datagram_).first(kHeaderBytes + payload_bytes);
}

}  // namespace boresight::ingest::someip
