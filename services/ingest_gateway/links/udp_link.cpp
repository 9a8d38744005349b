#include "services/ingest_gateway/links/udp_link.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include <net/if.h>
#include <netinet/in.h>
#include <sys/stat.h>

#include "services/common/runtime/socket_address.hpp"
#include "services/ingest_gateway/links/port_users.hpp"

namespace boresight::ingest {

namespace {

// Holds twenty detection lists of the largest radar, for each radar; the kernel's default of 208 KiB holds three.
constexpr int kUdpReceiveBuffer_bytes = 2 * 1024 * 1024;
constexpr unsigned kMaxReceiveBuffers = 16;
constexpr int kDatagramsPerTurn = 32;

std::string name_of(const recording::Endpoint& local) {
  const std::string address = recording::to_text(local.address);
  return "udp " + (local.address.is_v4() ? address : "[" + address + "]") + ":" + std::to_string(local.port);
}

/// The kernel's form of an address. IPv6 addresses that are valid on one link only need the interface's number.
socklen_t to_kernel(const recording::Endpoint& endpoint, unsigned interface_index, sockaddr_storage& out) {
  const socklen_t length = runtime::to_sockaddr(endpoint, out);
  const auto& bytes = endpoint.address.bytes;
  const bool one_link = bytes[0] == 0xFF || (bytes[0] == 0xFE && (bytes[1] & 0xC0) == 0x80);
  if (out.ss_family == AF_INET6 && one_link) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &out, sizeof(v6));
    v6.sin6_scope_id = interface_index;
    std::memcpy(&out, &v6, sizeof(v6));
  }
  return length;
}

}  // namespace

UdpLink::UdpLink(const recording::Endpoint& local, std::string interface, LinkEvents events, Sharing sharing)
    : local_(local),
      interface_(std::move(interface)),
      sharing_(sharing),
      name_(name_of(local)),
      events_(std::move(events)),
      buffer_(65536) {}

bool UdpLink::fail(const std::string& what) {
  events_.on_fault(Fault::kLink, name_ + ": " + what);
  socket_.reset();
  return false;
}

bool UdpLink::open() {
  const bool is_v4 = !is_v6();
  socket_ = Socket(socket(is_v4 ? AF_INET : AF_INET6, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket_.is_open()) return fail("cannot make a socket: " + last_error());
  interface_index_ = interface_.empty() ? 0 : if_nametoindex(interface_.c_str());
  if (!interface_.empty() && interface_index_ == 0) return fail("no interface named " + interface_);
  request_stamps_and_drops(socket_.get());
  reserve_receive_buffer();
  if (!bind_local()) return fail("cannot bind: " + last_error());
  choose_outgoing_interface(interface_index_);
  if (local_.address.is_multicast() && !join_group(interface_index_)) {
    return fail("cannot join the group: " + last_error());
  }
  kernel_drops_ = 0;
  return true;
}

void UdpLink::add_user() {
  ++users_;
  if (socket_.is_open()) reserve_receive_buffer();
}

void UdpLink::reserve_receive_buffer() {
  const int wanted = kUdpReceiveBuffer_bytes * static_cast<int>(std::min(users_, kMaxReceiveBuffers));
  const int given = request_receive_buffer(socket_.get(), wanted);
  // At least the size for one burst; more for a burst of each source that shares the socket.
  if (given < kUdpReceiveBuffer_bytes && !buffer_reported_) {
    buffer_reported_ = true;
    events_.on_fault(Fault::kLink, name_ + ": receive buffer is " + std::to_string(given) + " of " +
                                       std::to_string(kUdpReceiveBuffer_bytes) +
                                       " bytes needed; raise net.core.rmem_max");
  }
}

bool UdpLink::is_taken_by_another() const {
  const Socket probe(socket(is_v6() ? AF_INET6 : AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_storage address{};
  const socklen_t length = to_kernel(local_, interface_index_, address);
  return bind(probe.get(), reinterpret_cast<const sockaddr*>(&address), length) != 0 && errno == EADDRINUSE;
}

bool UdpLink::is_shared_with_another() const {
  struct stat own {};
  return fstat(socket_.get(), &own) == 0 && has_other_user(local_, own.st_ino);
}

bool UdpLink::bind_local() {
  recording::Endpoint bound = local_;
  has_own_port_ = sharing_ == Sharing::kPolite && is_taken_by_another();
  if (has_own_port_) {
    bound.port = 0;
    if (!sharing_reported_) {
      sharing_reported_ = true;
      events_.on_fault(Fault::kLink, name_ +
                                         ": another stack uses this port; discovery uses multicast and a separate "
                                         "port");
    }
  }
  const int on = 1;
  setsockopt(socket_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (local_.address.is_multicast()) {
    // Otherwise the socket would receive the group on every interface on which any program of this host joined it. No
    // SO_REUSEPORT: kernels of 2025 then deliver a member's datagram to any socket that shares the port.
    const int off = 0;
    if (is_v6()) {
      setsockopt(socket_.get(), IPPROTO_IPV6, IPV6_MULTICAST_ALL, &off, sizeof(off));
    } else {
      setsockopt(socket_.get(), IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof(off));
    }
  }
  sockaddr_storage address{};
  // Bound to the group, a socket receives no datagrams to other groups or hosts on the same port.
  const socklen_t length = to_kernel(bound, interface_index_, address);
  return bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), length) == 0;
}

bool UdpLink::join_group(unsigned interface_index) {
  group_req request{};
  request.gr_interface = interface_index;
  const socklen_t length = runtime::to_sockaddr({local_.address, 0}, request.gr_group);
  const int level = is_v6() ? IPPROTO_IPV6 : IPPROTO_IP;
  return length != 0 && setsockopt(socket_.get(), level, MCAST_JOIN_GROUP, &request, sizeof(request)) == 0;
}

void UdpLink::choose_outgoing_interface(unsigned interface_index) {
  if (!is_v6()) {
    ip_mreqn request{};
    request.imr_ifindex = static_cast<int>(interface_index);
    if (!local_.address.is_multicast()) request.imr_address.s_addr = htonl(local_.address.to_v4());
    setsockopt(socket_.get(), IPPROTO_IP, IP_MULTICAST_IF, &request, sizeof(request));
  } else {
    setsockopt(socket_.get(), IPPROTO_IPV6, IPV6_MULTICAST_IF, &interface_index, sizeof(interface_index));
  }
}

void UdpLink::check() {
  // An interface that was removed and created again has another index, and the kernel has dropped the membership.
  if (socket_.is_open() && !interface_.empty() && if_nametoindex(interface_.c_str()) != interface_index_) {
    fail("interface " + interface_ + " was removed or replaced");
  }
  // Another stack has started or ended: opened again, the link leaves the port to it or uses the port again.
  if (!socket_.is_open() || sharing_ != Sharing::kPolite) return;
  if (has_own_port_ ? !is_taken_by_another() : is_shared_with_another()) socket_.reset();
}

bool UdpLink::send(const recording::Endpoint& to, std::span<const std::uint8_t> payload) {
  if (!socket_.is_open()) return false;
  sockaddr_storage address{};
  const socklen_t length = to_kernel(to, interface_index_, address);
  const bool sent = sendto(socket_.get(), payload.data(), payload.size(), 0,
                           reinterpret_cast<const sockaddr*>(&address), length) >= 0;
  if (!sent && !sending_fails_) {
    events_.on_fault(Fault::kLink, name_ + ": cannot send to " + name_of(to) + ": " + last_error());
  }
  sending_fails_ = !sent;
  return sent;
}

void UdpLink::read() {
  for (int i = 0; i < kDatagramsPerTurn && socket_.is_open(); ++i) {
    Reception reception{.sender = {}, .stamp = {}, .drops = kernel_drops_};
    const ssize_t length = receive(socket_, buffer_, reception);
    if (length < 0) {
      // ECONNREFUSED: a peer refused an earlier datagram. ENETDOWN ends when the interface is back.
      if (errno != EAGAIN && errno != EINTR && errno != ECONNREFUSED && errno != ENETDOWN) {
        fail("receiving failed: " + last_error());
      }
      return;
    }
    report_drops(reception, kernel_drops_, "datagrams", events_);
    recording::Frame frame;
    frame.kind = recording::FrameKind::kUdp;
    frame.stamp_ns = reception.stamp.received_ns;
    frame.source = runtime::from_sockaddr(reception.sender);
    frame.destination = local_;
    frame.payload = {buffer_.data(), static_cast<std::size_t>(length)};
    events_.on_frame(frame, reception.stamp);
  }
}

}  // namespace boresight::ingest
