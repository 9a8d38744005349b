#include "services/ingest_gateway/links/port_users.hpp"

#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include <arpa/inet.h>

namespace boresight::ingest {

namespace {

template <typename Number>
bool parse(std::string_view text, int base, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return error == std::errc{} && end == text.data() + text.size();
}

/// The kernel prints addresses as words in its own byte order; in memory each word is in network order.
bool parse_address(std::string_view text, recording::IpAddress& address) {
  constexpr std::size_t kDigits = 8;
  std::array<std::uint32_t, 4> words{};
  if (text.size() != kDigits && text.size() != words.size() * kDigits) return false;
  for (std::size_t i = 0; i < text.size() / kDigits; ++i) {
    if (!parse(text.substr(i * kDigits, kDigits), 16, words[i])) return false;
  }
  std::array<std::uint8_t, 16> bytes;
  std::memcpy(bytes.data(), words.data(), bytes.size());
  const std::uint32_t v4 = ntohl(words[0]);
  address = text.size() == kDigits ? recording::IpAddress::v4(v4) : recording::IpAddress::v6(bytes);
  return true;
}

}  // namespace

bool has_other_user(std::istream& table, const recording::Endpoint& local, ino_t own) {
  for (std::string line; std::getline(table, line);) {
    // sl, local address:port, remote one, state, queues, timer, retransmissions, user, timeout, inode.
    constexpr std::size_t kLocal = 1, kInode = 9;
    std::array<std::string, kInode + 1> fields;
    std::istringstream words(line);
    for (std::string& field : fields) words >> field;
    const std::string_view endpoint = fields[kLocal];
    const std::size_t colon = endpoint.find(':');
    std::uint16_t port = 0;
    ino_t inode = 0;
    recording::IpAddress address;
    if (colon == std::string_view::npos || !parse(endpoint.substr(colon + 1), 16, port) ||
        !parse_address(endpoint.substr(0, colon), address) || !parse(std::string_view(fields[kInode]), 10, inode)) {
      continue;
    }
    const bool is_ours = address.is_unspecified() || address == local.address;
    if (port == local.port && inode != own && is_ours) return true;
  }
  return false;
}

bool has_other_user(const recording::Endpoint& local, ino_t own) {
  std::ifstream table(local.address.is_v4() ? "/proc/net/udp" : "/proc/net/udp6");
  return has_other_user(table, local, own);
}

}  // namespace boresight::ingest
