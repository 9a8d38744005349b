#include "tests/system/network/offers.hpp"

#include <array>
#include <cstring>
#include <ctime>
#include <stdexcept>

#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "services/common/recording/ip_address.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/socket_address.hpp"

namespace boresight::network {

namespace {

constexpr std::uint16_t kDiscoveryPort = 30490;

/// Whether a datagram is a SOME/IP-SD message whose first entry offers a service (AUTOSAR PRS SOME/IP-SD, 5.1.2.3).
bool is_offer(const std::uint8_t* bytes, std::size_t length) {
  constexpr std::size_t kFirstEntry = 24;
  constexpr std::uint8_t kOffer = 1;
  return length >= kFirstEntry + 16 && bytes[0] == 0xFF && bytes[1] == 0xFF && bytes[kFirstEntry] == kOffer &&
         (bytes[kFirstEntry + 9] | bytes[kFirstEntry + 10] | bytes[kFirstEntry + 11]) != 0;
}

}  // namespace

Offers::Offers(const TwoHosts& hosts, const std::string& group) : socket_(-1) {
  const recording::IpAddress address = recording::parse_ip(group).value();
  hosts.as(Host::kSensors, [&] {
    socket_ = socket(address.is_v4() ? AF_INET : AF_INET6, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const int on = 1;
    const int off = 0;
    setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on));
    // Only on the joined interface, not on those that other programs of this host joined.
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof(off));
    setsockopt(socket_, IPPROTO_IPV6, IPV6_MULTICAST_ALL, &off, sizeof(off));
    sockaddr_storage local{};
    const socklen_t length = runtime::to_sockaddr({address, kDiscoveryPort}, local);
    group_req request{};
    request.gr_interface = if_nametoindex(kServerInterface);
    static_cast<void>(runtime::to_sockaddr({address, 0}, request.gr_group));
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&local), length) != 0 ||
        setsockopt(socket_, address.is_v4() ? IPPROTO_IP : IPPROTO_IPV6, MCAST_JOIN_GROUP, &request, sizeof(request)) !=
            0) {
      throw std::runtime_error("cannot listen to offers");
    }
  });
}

Offers::~Offers() {
  close(socket_);
}

void Offers::forget() {
  listen();
  first_ns_.reset();
}

std::optional<std::int64_t> Offers::first_ns() {
  listen();
  return first_ns_;
}

void Offers::listen() {
  while (true) {
    std::array<std::uint8_t, 2048> bytes;
    alignas(cmsghdr) std::array<char, 128> control;
    iovec data{bytes.data(), bytes.size()};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t length = recvmsg(socket_, &message, 0);
    if (length < 0) return;
    const cmsghdr* const stamp = CMSG_FIRSTHDR(&message);
    if (first_ns_ || !is_offer(bytes.data(), static_cast<std::size_t>(length)) || stamp == nullptr) continue;
    timespec realtime{};
    std::memcpy(&realtime, CMSG_DATA(stamp), sizeof(realtime));
    const std::int64_t realtime_ns = static_cast<std::int64_t>(realtime.tv_sec) * 1'000'000'000 + realtime.tv_nsec;
    first_ns_ = realtime_ns - (runtime::realtime_now_ns() - runtime::monotonic_now_ns());
  }
}

}  // namespace boresight::network
