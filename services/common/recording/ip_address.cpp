#include "services/common/recording/ip_address.hpp"

#include <arpa/inet.h>

namespace boresight::recording {

std::optional<IpAddress> parse_ip(std::string_view text) {
  const std::string terminated(text);
  in_addr v4{};
  if (inet_pton(AF_INET, terminated.c_str(), &v4) == 1) return IpAddress::v4(ntohl(v4.s_addr));
  in6_addr v6{};
  if (inet_pton(AF_INET6, terminated.c_str(), &v6) != 1) return std::nullopt;
  return IpAddress::v6(std::span<const std::uint8_t, 16>(v6.s6_addr));
}

std::string to_text(const IpAddress& address) {
  if (address.is_unspecified()) return "";
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.is_v4()) {
    inet_ntop(AF_INET, address.bytes.data() + 12, text.data(), text.size());
  } else {
    inet_ntop(AF_INET6, address.bytes.data(), text.data(), text.size());
  }
  return text.data();
}

}  // namespace boresight::recording
