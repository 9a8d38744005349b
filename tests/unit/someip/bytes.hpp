// SOME/IP bytes for tests, written without the code under test.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "services/common/recording/ip_address.hpp"

namespace boresight::ingest::someip::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes from_hex(std::string_view text) {
  const auto digit = [](char c) -> int {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    throw std::invalid_argument("no hexadecimal digit");
  };
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(digit(text[i]) * 16 + digit(text[i + 1])));
  }
  return bytes;
}

inline void append(Bytes& to, std::span<const std::uint8_t> what) {
  to.insert(to.end(), what.begin(), what.end());
}

inline void append_number(Bytes& to, std::uint64_t value, unsigned number_of_bytes) {
  for (unsigned i = number_of_bytes; i > 0; --i) to.push_back(static_cast<std::uint8_t>(value >> (8 * (i - 1))));
}

struct Header {
  std::uint16_t service = 0x1234, method = 0x8021, client = 0, session = 7;
  std::uint8_t protocol = 1, interface = 2, type = 0x02, return_code = 0;
};

inline Bytes message(const Header& header, std::span<const std::uint8_t> payload) {
  Bytes bytes;
  append_number(bytes, header.service, 2);
  append_number(bytes, header.method, 2);
  append_number(bytes, payload.size() + 8, 4);
  append_number(bytes, header.client, 2);
  append_number(bytes, header.session, 2);
  for (const std::uint8_t b : {header.protocol, header.interface, header.type, header.return_code}) bytes.push_back(b);
  append(bytes, payload);
  return bytes;
}

/// A TP segment of `payload`: bytes [offset, offset + size).
inline Bytes segment(Header header, const Bytes& payload, std::size_t offset, std::size_t size, bool more) {
  header.type |= 0x20;
  Bytes body;
  append_number(body, offset | (more ? 1u : 0u), 4);
  append(body, std::span(payload).subspan(offset, size));
  return message(header, body);
}

/// All segments of a message, in order.
inline std::vector<Bytes> segments(const Header& header, const Bytes& payload, std::size_t segment_bytes) {
  std::vector<Bytes> all;
  for (std::size_t offset = 0; offset < payload.size(); offset += segment_bytes) {
    const std::size_t size = std::min(segment_bytes, payload.size() - offset);
    all.push_back(segment(header, payload, offset, size, offset + size < payload.size()));
  }
  return all;
}

inline Bytes random_bytes(std::mt19937& random, std::size_t size) {
  Bytes bytes(size);
  for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
  return bytes;
}

/// One to four random changes: bytes set, bits flipped, the end removed or extended.
inline Bytes mutated(std::mt19937& random, Bytes bytes) {
  for (std::size_t changes = 1 + random() % 4; changes > 0 && !bytes.empty(); --changes) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 5) {
      case 0:
        bytes[at] = static_cast<std::uint8_t>(random());
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 1u << random() % 8);
        break;
      case 2:
        bytes[at] = random() % 2 == 0 ? 0x00 : 0xFF;
        break;
      case 3:
        bytes.resize(at);
        break;
      default:
        bytes.insert(bytes.end(), 1 + random() % 40, static_cast<std::uint8_t>(random()));
    }
  }
  return bytes;
}

inline recording::Endpoint endpoint(std::uint32_t ipv4, std::uint16_t port) {
  return {recording::IpAddress::v4(ipv4), port};
}

}  // namespace boresight::ingest::someip::test
