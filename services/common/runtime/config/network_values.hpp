// Pure checks of configured addresses, names of network interfaces, and paths of sockets.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace boresight::config {

/// Stands for every network interface of the machine.
inline constexpr std::string_view kAllInterfaces = "all";

/// What is wrong with a list of this machine's network interfaces; nullopt if nothing is. An entry is a name that Linux
/// allows, or an IPv4 address of one host (not 0.0.0.0, multicast or broadcast), and is named once. kAllInterfaces must
/// be the only entry, and an empty list is wrong. Whether an interface exists is not checked.
[[nodiscard]] std::optional<std::string> problem_of_interfaces(std::span<const std::string> interfaces);

/// True for a name that Linux allows for a network interface: 1 … 15 bytes without '/', ':', blanks and control
/// characters, and neither "." nor "..".
[[nodiscard]] bool is_interface_name(std::string_view name);

/// What is wrong with the path of a local socket; nullopt if nothing is. Linux allows 107 bytes.
[[nodiscard]] std::optional<std::string> problem_of_socket_path(std::string_view path);

}  // namespace boresight::config
