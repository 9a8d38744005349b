#include "services/common/runtime/config/network_values.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>
#include <net/if.h>
#include <sys/un.h>

#include "services/common/recording/ip_address.hpp"

namespace boresight::config {

namespace {

/// Nothing but digits and dots: meant as an address, although Linux would allow it as a name.
bool looks_like_an_address(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789.") == std::string_view::npos;
}

}  // namespace

std::optional<std::string> problem_of_interfaces(std::span<const std::string> interfaces) {
  constexpr std::uint32_t kBroadcast = 0xFFFFFFFF;
  if (interfaces.empty()) return "is empty; must name interfaces, or be [\"all\"]";
  for (auto text = interfaces.begin(); text != interfaces.end(); ++text) {
    if (*text == kAllInterfaces && interfaces.size() > 1) return "\"all\" must be the only entry";
    const auto address = recording::parse_ip(*text);
    if (address && address->is_v4()) {
      if (address->is_multicast() || address->to_v4() == kBroadcast) {
        return fmt::format("\"{}\" is not allowed; must be addresses of single interfaces", *text);
      }
    } else if (address || looks_like_an_address(*text) || !is_interface_name(*text)) {
      return fmt::format("\"{}\" is not allowed; must be names or IPv4 addresses of this machine's interfaces", *text);
    }
    if (std::find(interfaces.begin(), text, *text) != text) {
      return fmt::format("\"{}\" must be named once only", *text);
    }
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
