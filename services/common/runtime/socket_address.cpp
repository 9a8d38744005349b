#include "services/common/runtime/socket_address.hpp"

#include <cstring>

#include <netinet/in.h>

namespace boresight::runtime {

socklen_t to_sockaddr(const recording::Endpoint& endpoint, sockaddr_storage& out) {
  out = {};
  if (endpoint.address.is_v4() || endpoint.address.is_unspecified()) {
    sockaddr_in v4{};
    v4.sin_family = AF_INET;
    v4.sin_addr.s_addr = htonl(endpoint.address.to_v4());
    v4.sin_port = htons(endpoint.port);
    std::memcpy(&out, &v4, sizeof(v4));
    return sizeof(v4);
  }
  sockaddr_in6 v6{};
  v6.sin6_family = AF_INET6;
  std::memcpy(&v6.sin6_addr, endpoint.address.bytes.data(), sizeof(v6.sin6_addr));
  v6.sin6_port = htons(endpoint.port);
  std::memcpy(&out, &v6, sizeof(v6));
  return sizeof(v6);
}

recording::Endpoint from_sockaddr(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &address, sizeof(v4));
    return {recording::IpAddress::v4(ntohl(v4.sin_addr.s_addr)), ntohs(v4.sin_port)};
  }
  if (address.ss_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &address, sizeof(v6));
    return {recording::IpAddress::v6(v6.sin6_addr.s6_addr), ntohs(v6.sin6_port)};
  }
  return {};
}

}  // namespace boresight::runtime
