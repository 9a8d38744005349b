#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <sys/socket.h>
#include <unistd.h>

#include "services/common/runtime/can_socket.hpp"
#include "services/common/runtime/socket_address.hpp"
#include "services/replay/senders/sender.hpp"

namespace boresight::replay {

namespace {

recording::IpAddress parse(const std::string& text) {
  const auto address = recording::parse_ip(text);
  if (!address) throw std::runtime_error(text + " is not an IP address");
  return *address;
}

class WireSender : public Sender {
 public:
  explicit WireSender(const std::map<std::string, std::string>& routes) {
    for (const auto& [recorded, local] : routes) routes_[parse(recorded)] = parse(local);
  }
  ~WireSender() override {
    for (const auto& [key, descriptor] : udp_) ::close(descriptor);
    for (const auto& [key, descriptor] : can_) ::close(descriptor);
  }
  WireSender(const WireSender&) = delete;
  WireSender& operator=(const WireSender&) = delete;

  bool send(const recording::Frame& frame) override {
    return frame.kind == recording::FrameKind::kUdp ? send_udp(frame) : send_can(frame);
  }

 private:
  [[nodiscard]] recording::IpAddress route(const recording::IpAddress& recorded) const {
    const auto found = routes_.find(recorded);
    return found == routes_.end() ? recorded : found->second;
  }

  int udp_socket(const recording::IpAddress& source, sa_family_t family) {
    const auto found = udp_.find(source);
    if (found != udp_.end()) return found->second;
    const int descriptor = socket(family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (descriptor < 0) throw std::runtime_error(std::string("cannot make a UDP socket: ") + std::strerror(errno));
    sockaddr_storage address{};
    const socklen_t length = runtime::to_sockaddr({source, 0}, address);
    // The socket cannot use a sender's address of another machine; the gateway then needs no `sender`, or a route.
    static_cast<void>(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), length));
    return udp_[source] = descriptor;
  }

  bool send_udp(const recording::Frame& frame) {
    sockaddr_storage to{};
    const socklen_t length = runtime::to_sockaddr({route(frame.destination.address), frame.destination.port}, to);
    const int descriptor = udp_socket(route(frame.source.address), to.ss_family);
    return sendto(descriptor, frame.payload.data(), frame.payload.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                  length) >= 0;
  }

  int can_socket(const std::string& interface) {
    const auto found = can_.find(interface);
    if (found != can_.end()) return found->second;
    std::string problem;
    const int descriptor = runtime::open_can_socket(interface, false, problem);
    if (descriptor < 0) throw std::runtime_error(interface + ": " + problem);
    return can_[interface] = descriptor;
  }

  bool send_can(const recording::Frame& frame) {
    canfd_frame raw{};
    const std::size_t size = runtime::to_kernel(frame, raw);
    return write(can_socket(std::string(frame.interface_name())), &raw, size) == static_cast<ssize_t>(size);
  }

  std::map<recording::IpAddress, recording::IpAddress> routes_;
  std::map<recording::IpAddress, int> udp_;
  std::map<std::string, int> can_;
};

}  // namespace

std::unique_ptr<Sender> make_wire_sender(const std::map<std::string, std::string>& routes) {
  return std::make_unique<WireSender>(routes);
}

}  // namespace boresight::replay
