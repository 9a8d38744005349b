// Pure checks of configured addresses, names of network interfaces, and paths of sockets.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace boresight::config {

/// What is wrong with a list of IPv4 addresses of this machine's interfaces; nullopt if nothing is. Each address must
/// be IPv4, that of one host (not 0.0.0.0, multicast or broadcast), and be named once. An empty list is allowed.
[[nodiscard]] std::optional<std::string> problem_of_ipv4_addresses(std::span<const std::string> addresses);

/// True for a name that Linux allows for a network interface: 1 … 15 bytes without '/', ':', blanks and control
/// characters, and neither "." nor "..".
[[nodiscard]] bool is_interface_name(std::string_view name);

/// What is wrong with the path of a local socket; nullopt if nothing is. Linux allows 107 bytes.
[[nodiscard]] std::optional<std::string> problem_of_socket_path(std::string_view path);

}  // namespace boresight::config
