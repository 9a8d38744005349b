#include "tests/benchmarks/ingest/load/ars548_radars.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/socket_address.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/ingest_gateway/links/socket.hpp"
#include "tests/benchmarks/ingest/load/network.hpp"
#include "tests/benchmarks/ingest/scans.hpp"

namespace boresight::bench {

namespace {

constexpr std::int64_t kEgoPeriod_ns = 20'000'000;
constexpr auto kListPeriod_ns = static_cast<std::int64_t>(1e9 / kRate_hz / kRadars);
// Lists that differ, so that they do not count as frozen.
constexpr std::uint32_t kDifferentCycles = 4;

int open_socket(const recording::Endpoint& local) {
  const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_storage address{};
  const socklen_t length = runtime::to_sockaddr(local, address);
  ip_mreqn out{};
  out.imr_ifindex = static_cast<int>(if_nametoindex("radar0"));
  const int buffer = 4 * 1024 * 1024;
  setsockopt(descriptor, SOL_SOCKET, SO_SNDBUFFORCE, &buffer, sizeof(buffer));
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&address), length) != 0 ||
      setsockopt(descriptor, IPPROTO_IP, IP_MULTICAST_IF, &out, sizeof(out)) != 0) {
    throw std::runtime_error("cannot open a radar's socket: " + ingest::last_error());
  }
  return descriptor;
}

bool send_to(int descriptor, const recording::Endpoint& to, std::span<const std::uint8_t> datagram) {
  sockaddr_storage address{};
  const socklen_t length = runtime::to_sockaddr(to, address);
  return sendto(descriptor, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&address), length) ==
         static_cast<ssize_t>(datagram.size());
}

/// The sensors' side of the network.
class Sensors {
 public:
  Sensors() : ego_socket_(open_socket(kEgoServer)), ego_encoder_({0x42530101, 0x42530102}) {
    for (std::uint32_t radar = 0; radar < kRadars; ++radar) {
      sockets_[radar] = open_socket({recording::IpAddress::v4(kFirstArs548Address + radar), kArs548Group.port});
      for (std::uint32_t cycle = 0; cycle < kDifferentCycles; ++cycle) {
        lists_[radar].push_back(ars548_list(*synthetic_scan(radar + 1, cycle, kDetections), 0));
      }
    }
    replay::write_synthetic_ego(ego_);
  }

  bool send_list() {
    const std::uint32_t radar = next_ % kRadars, cycle = next_ / kRadars;
    ++next_;
    Bytes& list = lists_[radar][cycle % kDifferentCycles];
    advance_ars548(list, runtime::realtime_now_ns(), cycle + 1);
    return send_to(sockets_[radar], kArs548Group, list);
  }
  void send_ego() {
    static_cast<void>(send_to(ego_socket_, kEcuEvents, ego_encoder_.ego_motion(ego_, {runtime::realtime_now_ns(), 1})));
  }

 private:
  std::array<int, kRadars> sockets_{};
  std::array<std::vector<Bytes>, kRadars> lists_;
  int ego_socket_;
  replay::EventEncoder ego_encoder_;
  EgoMotion ego_{};
  std::uint32_t next_ = 0;
};

}  // namespace

Ars548Radars::Ars548Radars() : process_(std::make_unique<harness::Child>([this] { return run(); })) {}

void Ars548Radars::send_for(double seconds) {
  control_->at_once = false;
  control_->lists_to_send = static_cast<std::uint32_t>(std::lround(seconds * kRate_hz)) * kRadars;
}

void Ars548Radars::send_burst(std::uint32_t lists) {
  control_->at_once = true;
  control_->lists_to_send = lists;
}

int Ars548Radars::run() {
  runtime::install_stop_signals();
  enter_radars_network();
  Sensors sensors;
  std::int64_t next_ego_ns = runtime::monotonic_now_ns(), next_list_ns = next_ego_ns;
  while (!runtime::stop_signalled()) {
    std::int64_t now_ns = runtime::monotonic_now_ns();
    const bool at_once = control_->at_once;
    if (control_->lists_to_send > 0 && (at_once || now_ns >= next_list_ns)) {
      // The period starts now if the previous one has ended.
      next_list_ns = std::max(next_list_ns, now_ns - kListPeriod_ns) + kListPeriod_ns;
      if (sensors.send_list()) {
        control_->sent = control_->sent + 1;
      } else {
        control_->refused = control_->refused + 1;
      }
      control_->lists_to_send = control_->lists_to_send - 1;
      if (at_once) continue;
    }
    if (now_ns >= next_ego_ns) {
      sensors.send_ego();
      next_ego_ns += kEgoPeriod_ns;
    }
    now_ns = runtime::monotonic_now_ns();
    // A command takes effect within a millisecond.
    const std::int64_t until_ns =
        std::min({next_ego_ns, now_ns + 1'000'000, control_->lists_to_send > 0 ? next_list_ns : next_ego_ns});
    if (until_ns > now_ns) harness::sleep_s(static_cast<double>(until_ns - now_ns) * 1e-9);
  }
  return 0;
}

std::unique_ptr<harness::Child> start_bare_receiver() {
  return std::make_unique<harness::Child>([] {
    runtime::install_stop_signals();
    const ingest::Socket receiver(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    const int on = 1;
    setsockopt(receiver.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    static_cast<void>(ingest::request_receive_buffer(receiver.get(), 2 * 1024 * 1024));
    sockaddr_storage address{};
    const socklen_t length = runtime::to_sockaddr(kArs548Group, address);
    ip_mreqn group{};
    group.imr_multiaddr = reinterpret_cast<const sockaddr_in&>(address).sin_addr;
    group.imr_ifindex = static_cast<int>(if_nametoindex("ecu0"));
    if (bind(receiver.get(), reinterpret_cast<const sockaddr*>(&address), length) != 0 ||
        setsockopt(receiver.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof(group)) != 0) {
      return 1;
    }
    Bytes buffer(65536);
    while (!runtime::stop_signalled()) {
      pollfd polled{.fd = receiver.get(), .events = POLLIN, .revents = 0};
      if (poll(&polled, 1, 50) <= 0) continue;
      while (recv(receiver.get(), buffer.data(), buffer.size(), 0) >= 0) {
      }
    }
    return 0;
  });
}

}  // namespace boresight::bench
