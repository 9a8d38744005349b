#include "services/common/runtime/udp_socket.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "services/common/runtime/socket_address.hpp"

namespace boresight::runtime {

namespace {

/// The kernel's form of an address. IPv6 addresses that are valid on one link only need the interface's number.
socklen_t kernel_address(const recording::Endpoint& endpoint, unsigned interface_index, sockaddr_storage& out) {
  const socklen_t size = to_sockaddr(endpoint, out);
  const auto& bytes = endpoint.address.bytes;
  const bool one_link = bytes[0] == 0xFF || (bytes[0] == 0xFE && (bytes[1] & 0xC0) == 0x80);
  if (out.ss_family == AF_INET6 && one_link) reinterpret_cast<sockaddr_in6&>(out).sin6_scope_id = interface_index;
  return size;
}

}  // namespace

UdpSocket::UdpSocket(const recording::Endpoint& local, const std::string& interface)
    : local_(local), v4_(local.address.is_v4()), interface_index_(if_nametoindex(interface.c_str())), descriptor_(-1) {
  if (interface_index_ == 0) throw std::runtime_error("no interface named " + interface);
  descriptor_ = socket(v4_ ? AF_INET : AF_INET6, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor_ < 0) throw std::runtime_error(name() + ": cannot make a socket: " + std::strerror(errno));
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : local_(other.local_),
      v4_(other.v4_),
      interface_index_(other.interface_index_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

UdpSocket::~UdpSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string UdpSocket::name() const {
  return recording::to_text(local_.address) + " port " + std::to_string(local_.port);
}

void UdpSocket::set(int level, int option, const void* value, std::size_t bytes, const char* what) const {
  if (setsockopt(descriptor_, level, option, value, static_cast<socklen_t>(bytes)) != 0) {
    throw std::runtime_error(name() + ": cannot " + what + ": " + std::strerror(errno));
  }
}

void UdpSocket::bind_to(const recording::Endpoint& local) const {
  sockaddr_storage address{};
  const socklen_t size = kernel_address(local, interface_index_, address);
  if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), size) != 0) {
    throw std::runtime_error(name() + ": cannot bind: " + std::strerror(errno));
  }
}

UdpSocket UdpSocket::bound_to(const recording::Endpoint& local, const std::string& interface, int hops) {
  UdpSocket socket(local, interface);
  const int on = 1;
  // Another stack on this machine may use the wildcard address with the same port.
  socket.set(SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on), "share the address");
  // For a burst of all radars' longest lists; the kernel may grant less.
  const int send_buffer = 4 * 1024 * 1024;
  setsockopt(socket.descriptor_, SOL_SOCKET, SO_SNDBUF, &send_buffer, sizeof(send_buffer));
  if (socket.v4_) {
    ip_mreqn request{};
    request.imr_ifindex = static_cast<int>(socket.interface_index_);
    socket.set(IPPROTO_IP, IP_MULTICAST_IF, &request, sizeof(request), "choose the interface for multicast");
    socket.set(IPPROTO_IP, IP_MULTICAST_TTL, &hops, sizeof(hops), "set the time to live");
    socket.set(IPPROTO_IP, IP_MULTICAST_LOOP, &on, sizeof(on), "reach this machine by multicast");
  } else {
    const int index = static_cast<int>(socket.interface_index_);
    socket.set(IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof(on), "keep to IPv6");
    socket.set(IPPROTO_IPV6, IPV6_MULTICAST_IF, &index, sizeof(index), "choose the interface for multicast");
    socket.set(IPPROTO_IPV6, IPV6_MULTICAST_HOPS, &hops, sizeof(hops), "set the time to live");
    socket.set(IPPROTO_IPV6, IPV6_MULTICAST_LOOP, &on, sizeof(on), "reach this machine by multicast");
  }
  socket.bind_to(local);
  return socket;
}

UdpSocket UdpSocket::member_of(const recording::Endpoint& group, const std::string& interface) {
  UdpSocket socket(group, interface);
  const int on = 1, off = 0;
  // No SO_REUSEPORT: Linux 6.18 may deliver a datagram to a sharing socket of another interface.
  socket.set(SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on), "share the address");
  // Bound to the group, the socket receives no datagrams to other addresses.
  socket.bind_to(group);
  if (socket.v4_) {
    ip_mreqn request{};
    sockaddr_storage address{};
    static_cast<void>(to_sockaddr(group, address));
    request.imr_multiaddr = reinterpret_cast<const sockaddr_in&>(address).sin_addr;
    request.imr_ifindex = static_cast<int>(socket.interface_index_);
    socket.set(IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof(off), "keep to its own memberships");
    socket.set(IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof(request), "join the group");
  } else {
    ipv6_mreq request{};
    std::memcpy(&request.ipv6mr_multiaddr, group.address.bytes.data(), sizeof(request.ipv6mr_multiaddr));
    request.ipv6mr_interface = socket.interface_index_;
    socket.set(IPPROTO_IPV6, IPV6_ADD_MEMBERSHIP, &request, sizeof(request), "join the group");
  }
  return socket;
}

bool UdpSocket::send(const recording::Endpoint& to, std::span<const std::uint8_t> datagram) const {
  // A receiver with the other IP version is not reachable.
  if (to.address.is_v4() != v4_) return false;
  sockaddr_storage address{};
  const socklen_t size = kernel_address(to, interface_index_, address);
  return sendto(descriptor_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&address), size) ==
         static_cast<ssize_t>(datagram.size());
}

std::optional<std::span<const std::uint8_t>> UdpSocket::receive(std::span<std::uint8_t> buffer,
                                                                recording::Endpoint& from) const {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  const ssize_t length =
      recvfrom(descriptor_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&address), &size);
  if (length < 0) return std::nullopt;
  from = from_sockaddr(address);
  return buffer.first(static_cast<std::size_t>(length));
}

}  // namespace boresight::runtime
