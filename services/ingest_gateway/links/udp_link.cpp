#include "services/ingest_gateway/links/udp_link.hpp"

#include <cerrno>
#include <string>

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>

namespace boresight::ingest {

namespace {

// Twenty queued detection lists of the largest radar; the kernel's default of 208 KiB kept three of them.
constexpr int kReceiveBuffer = 2 * 1024 * 1024;
constexpr int kFramesPerTurn = 32;

}  // namespace

UdpLink::UdpLink(std::string address, std::uint16_t port, std::string interface, LinkEvents events)
    : address_(std::move(address)),
      port_(port),
      interface_(std::move(interface)),
      name_("udp " + address_ + ":" + std::to_string(port)),
      events_(std::move(events)),
      buffer_(65536) {}

bool UdpLink::fail(const std::string& what) {
  events_.on_fault(Fault::kLink, name_ + ": " + what);
  socket_.reset();
  return false;
}

bool UdpLink::open() {
  in_addr local{};
  if (inet_pton(AF_INET, address_.c_str(), &local) != 1) return fail("address is not IPv4");
  address_host_ = ntohl(local.s_addr);
  socket_ = Socket(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket_.is_open()) return fail("cannot make a socket: " + last_error());
  const int on = 1;
  setsockopt(socket_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  request_stamps_and_drops(socket_.get());
  const int given = request_receive_buffer(socket_.get(), kReceiveBuffer);
  if (given < kReceiveBuffer && !buffer_reported_) {
    buffer_reported_ = true;
    events_.on_fault(Fault::kLink, name_ + ": receive buffer is " + std::to_string(given) +
                                       " of 2097152 bytes wanted; raise net.core.rmem_max");
  }
  sockaddr_in bound{};
  bound.sin_family = AF_INET;
  bound.sin_port = htons(port_);
  // Bound to the group itself, a socket does not receive what is sent to other groups or hosts on the same port.
  bound.sin_addr = local;
  if (bind(socket_.get(), reinterpret_cast<const sockaddr*>(&bound), sizeof(bound)) != 0) {
    return fail("cannot bind: " + last_error());
  }
  if (IN_MULTICAST(address_host_)) {
    ip_mreqn request{};
    request.imr_multiaddr = local;
    if (!interface_.empty()) {
      request.imr_ifindex = static_cast<int>(if_nametoindex(interface_.c_str()));
      if (request.imr_ifindex == 0) return fail("no interface named " + interface_);
    }
    if (setsockopt(socket_.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof(request)) != 0) {
      return fail("cannot join the group: " + last_error());
    }
  }
  kernel_drops_ = 0;
  return true;
}

void UdpLink::read() {
  for (int i = 0; i < kFramesPerTurn; ++i) {
    sockaddr_in sender{};
    iovec data{buffer_.data(), buffer_.size()};
    alignas(cmsghdr) std::array<char, 256> control{};
    msghdr message{};
    message.msg_name = &sender;
    message.msg_namelen = sizeof(sender);
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t length = recvmsg(socket_.get(), &message, 0);
    if (length < 0) {
      if (errno != EAGAIN && errno != EINTR) fail("receiving failed: " + last_error());
      return;
    }
    std::uint32_t drops = kernel_drops_;
    const FrameStamp stamp = read_control(message, drops);
    if (drops != kernel_drops_) {
      kernel_drops_ = drops;
      events_.on_fault(Fault::kLink, "the kernel dropped datagrams: its receive buffer was full");
    }
    recording::Frame frame;
    frame.kind = recording::FrameKind::kUdp;
    frame.stamp_ns = stamp.received_ns;
    frame.source = {recording::IpAddress::v4(ntohl(sender.sin_addr.s_addr)), ntohs(sender.sin_port)};
    frame.destination = {recording::IpAddress::v4(address_host_), port_};
    frame.payload = {buffer_.data(), static_cast<std::size_t>(length)};
    events_.on_frame(frame, stamp);
  }
}

}  // namespace boresight::ingest
