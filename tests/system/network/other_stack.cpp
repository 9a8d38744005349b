#include "tests/system/network/other_stack.hpp"

#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <arpa/inet.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/system/network/story.hpp"

namespace boresight::network {

namespace {

constexpr std::uint16_t kOtherStackDiscoveryPort = 30490;
constexpr std::string_view kLetter = "a peer's letter";

sockaddr_in endpoint(const std::string& address) {
  sockaddr_in in{};
  in.sin_family = AF_INET;
  in.sin_port = htons(kOtherStackDiscoveryPort);
  inet_pton(AF_INET, address.c_str(), &in.sin_addr);
  return in;
}

int socket_at(const std::string& address) {
  const int made = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(made, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  const sockaddr_in local = endpoint(address);
  if (bind(made, reinterpret_cast<const sockaddr*>(&local), sizeof(local)) != 0) {
    throw std::runtime_error("the other stack cannot bind the discovery port of " + address);
  }
  return made;
}

/// Reads all waiting datagrams; true if one of them satisfies the condition.
template <typename Condition>
bool receives(int from, Condition condition) {
  std::array<char, 2048> bytes;
  bool found = false;
  for (ssize_t length; (length = recv(from, bytes.data(), bytes.size(), 0)) >= 0;) {
    found = condition(std::string_view(bytes.data(), static_cast<std::size_t>(length))) || found;
  }
  return found;
}

}  // namespace

OtherStack::OtherStack(const TwoHosts& hosts, const std::string& address, const std::string& interface) {
  if (!address.empty()) unicast_ = socket_at(address);
  multicast_ = socket_at(kGroupV4);
  ip_mreqn request{};
  inet_pton(AF_INET, kGroupV4, &request.imr_multiaddr);
  request.imr_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (setsockopt(multicast_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof(request)) != 0) {
    throw std::runtime_error("the other stack cannot join the discovery group on " + interface);
  }
  hosts.as(Host::kSensors, [this] { peer_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0); });
}

OtherStack::OtherStack(OtherStack&& other) noexcept
    : unicast_(std::exchange(other.unicast_, -1)),
      multicast_(std::exchange(other.multicast_, -1)),
      peer_(std::exchange(other.peer_, -1)) {}

OtherStack::~OtherStack() {
  for (const int descriptor : {unicast_, multicast_, peer_}) {
    if (descriptor >= 0) close(descriptor);
  }
}

OtherStack OtherStack::member_on(const TwoHosts& hosts, const std::string& interface) {
  return {hosts, "", interface};
}

OtherStack OtherStack::at(const TwoHosts& hosts, const std::string& address) {
  return {hosts, address, kEcuInterface};
}

bool OtherStack::hears_offer(double seconds) const {
  return harness::eventually(seconds, [this] {
    return receives(multicast_, [](std::string_view datagram) {
      return datagram.size() >= 40 && datagram.substr(0, 4) == "\xFF\xFF\x81" + std::string(1, '\0') &&
             datagram[24] == 1;
    });
  });
}

bool OtherStack::gets_unicast(double seconds) const {
  const sockaddr_in to = endpoint(kEcuAddress);
  return harness::eventually(seconds, [&] {
    sendto(peer_, kLetter.data(), kLetter.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
    return receives(unicast_, [](std::string_view datagram) { return datagram == kLetter; });
  });
}

}  // namespace boresight::network
