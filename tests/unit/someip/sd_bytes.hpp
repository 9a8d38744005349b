// A server's service discovery messages, written without the code under test.
#pragma once

#include "tests/unit/someip/bytes.hpp"

namespace boresight::ingest::someip::test {

struct Entry {
  std::uint8_t type = 0x01;
  std::uint16_t service = 0x1234, instance = 1;
  std::uint8_t major = 2;
  std::uint32_t ttl_s = 3;
  std::uint32_t last = 0;  ///< minor version, or counter and eventgroup
  std::uint8_t index_1 = 0, index_2 = 0, number_1 = 0, number_2 = 0;
};

inline Bytes entry_bytes(const Entry& e) {
  Bytes bytes{e.type, e.index_1, e.index_2, static_cast<std::uint8_t>(e.number_1 << 4 | e.number_2)};
  append_number(bytes, e.service, 2);
  append_number(bytes, e.instance, 2);
  append_number(bytes, e.major, 1);
  append_number(bytes, e.ttl_s, 3);
  append_number(bytes, e.last, 4);
  return bytes;
}

inline Bytes option(std::uint8_t type, const Bytes& content, bool discardable = false) {
  Bytes bytes;
  append_number(bytes, content.size() + 1, 2);
  bytes.push_back(type);
  bytes.push_back(discardable ? 0x80 : 0);
  append(bytes, content);
  return bytes;
}

inline Bytes ipv4_option(std::uint32_t address, std::uint16_t port, std::uint8_t type = 0x04,
                         std::uint8_t protocol = 0x11) {
  Bytes content;
  append_number(content, address, 4);
  append_number(content, protocol, 2);
  append_number(content, port, 2);
  return option(type, content);
}

inline Bytes ipv6_option(const recording::IpAddress& address, std::uint16_t port, std::uint8_t type = 0x06) {
  Bytes content(address.bytes.begin(), address.bytes.end());
  append_number(content, 0x11, 2);
  append_number(content, port, 2);
  return option(type, content);
}

struct Sd {
  std::uint16_t session = 1;
  std::uint8_t flags = 0xC0;
  std::vector<Entry> entries{};
  std::vector<Bytes> options{};
};

inline Bytes sd_payload(const Sd& sd) {
  Bytes bytes{sd.flags, 0, 0, 0};
  append_number(bytes, sd.entries.size() * 16, 4);
  for (const Entry& e : sd.entries) append(bytes, entry_bytes(e));
  Bytes options;
  for (const Bytes& o : sd.options) append(options, o);
  append_number(bytes, options.size(), 4);
  append(bytes, options);
  return bytes;
}

inline constexpr Header kSdHeader{.service = 0xFFFF, .method = 0x8100, .session = 1, .interface = 1};

inline Bytes sd_datagram(const Sd& sd) {
  Header header = kSdHeader;
  header.session = sd.session;
  return message(header, sd_payload(sd));
}

}  // namespace boresight::ingest::someip::test
