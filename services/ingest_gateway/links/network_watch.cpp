#include "services/ingest_gateway/links/network_watch.hpp"

#include <array>
#include <cerrno>
#include <cstring>

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>

namespace boresight::ingest {

bool is_running(const std::string& interface) {
  const Socket any(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request{};
  if (!any.is_open() || interface.size() >= sizeof(request.ifr_name)) return false;
  std::memcpy(request.ifr_name, interface.c_str(), interface.size());
  if (ioctl(any.get(), SIOCGIFFLAGS, &request) != 0) return false;
  const auto flags = static_cast<unsigned>(request.ifr_flags);
  return (flags & IFF_UP) != 0 && (flags & IFF_RUNNING) != 0;
}

bool NetworkWatch::open() {
  socket_ = Socket(socket(AF_NETLINK, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, NETLINK_ROUTE));
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = RTMGRP_LINK | RTMGRP_IPV4_IFADDR | RTMGRP_IPV6_IFADDR;
  if (socket_.is_open() && bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
    return true;
  }
  if (!failure_reported_) {
    failure_reported_ = true;
    events_.on_fault(Fault::kLink, name_ + ": " + last_error() + "; interfaces are checked only once a second");
  }
  socket_.reset();
  return false;
}

void NetworkWatch::read() {
  std::array<char, 8192> news;
  bool any = false;
  // Bounded: remaining messages wake the node again. ENOBUFS means lost messages, which is a change as well.
  for (int i = 0; i < 64; ++i) {
    const ssize_t length = recv(socket_.get(), news.data(), news.size(), 0);
    if (length < 0 && errno != ENOBUFS) break;
    any = true;
  }
  if (any) on_change_();
}

}  // namespace boresight::ingest
