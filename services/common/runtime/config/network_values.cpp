#include "services/common/runtime/config/network_values.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>
#include <net/if.h>
#include <sys/un.h>

#include "services/common/recording/ip_address.hpp"

namespace boresight::config {

std::optional<std::string> problem_of_ipv4_addresses(std::span<const std::string> addresses) {
  constexpr std::uint32_t kBroadcast = 0xFFFFFFFF;
  for (auto text = addresses.begin(); text != addresses.end(); ++text) {
    const auto address = recording::parse_ip(*text);
    if (!address || !(address->is_v4() || address->is_unspecified())) {
      return fmt::format("\"{}\" is not allowed; must be IPv4 addresses of this machine's interfaces", *text);
    }
    if (address->is_unspecified() || address->is_multicast() || address->to_v4() == kBroadcast) {
      return fmt::format("\"{}\" is not allowed; must be addresses of single interfaces", *text);
    }
    if (std::find(addresses.begin(), text, *text) != text) return fmt::format("\"{}\" must be named once only", *text);
  }
  return std::nullopt;
}

bool is_interface_name(std::string_view name) {
  const auto is_forbidden = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte <= ' ' || byte == 0x7F || c == '/' || c == ':';
  };
  return !name.empty() && name.size() < IFNAMSIZ && name != "." && name != ".." &&
         std::none_of(name.begin(), name.end(), is_forbidden);
}

std::optional<std::string> problem_of_socket_path(std::string_view path) {
  constexpr std::size_t kMaxBytes = sizeof(sockaddr_un::sun_path) - 1;
  if (path.size() <= kMaxBytes) return std::nullopt;
  return fmt::format("has {} bytes; must be a path of at most {}", path.size(), kMaxBytes);
}

}  // namespace boresight::config
