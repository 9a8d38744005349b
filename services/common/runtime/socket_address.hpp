// Converts address values to and from the kernel's form.
#pragma once

#include <sys/socket.h>

#include "services/common/recording/ip_address.hpp"

namespace boresight::runtime {

/// Fills `out` and returns its length; an unspecified address becomes the IPv4 wildcard.
[[nodiscard]] socklen_t to_sockaddr(const recording::Endpoint& endpoint, sockaddr_storage& out);

/// Unspecified for families other than IPv4 and IPv6.
[[nodiscard]] recording::Endpoint from_sockaddr(const sockaddr_storage& address);

}  // namespace boresight::runtime
