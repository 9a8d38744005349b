// Offers a SOME/IP service on the network: the two sockets of service discovery and their messages.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/runtime/udp_socket.hpp"
#include "services/common/someip/sd_server.hpp"

namespace boresight::runtime {

struct DiscoveryOptions {
  std::string interface;         ///< "eth0"
  recording::IpAddress address;  ///< of this machine on that interface
  recording::Endpoint group;     ///< multicast group and port of discovery
  int multicast_hops = 1;
};

/// Callbacks; each may be empty.
struct DiscoveryEvents {
  std::function<void(const recording::IpAddress& from, std::string_view what)> on_problem;
  std::function<void(const someip::SdServer::NewSubscriber&)> on_new_subscriber;  ///< its Ack has been sent
};

class DiscoveryServer {
 public:
  /// Opens the sockets (throws std::runtime_error) and begins the initial wait, which is random. The TTL of offers
  /// follows from their cycle.
  DiscoveryServer(DiscoveryOptions options, someip::SdServerConfig config, DiscoveryEvents events);

  /// Descriptors to wait for.
  [[nodiscard]] std::array<int, 2> descriptors() const { return {unicast_.descriptor(), multicast_.descriptor()}; }
  [[nodiscard]] std::int64_t next_due_ns() const { return server_.next_due_ns(); }
  /// Sends the offers that are due.
  void tick(std::int64_t now_ns);
  /// Reads and answers received datagrams, some dozens at most, without waiting.
  void receive();
  /// Withdraws the offers.
  void stop();

  [[nodiscard]] std::span<const recording::Endpoint> destinations(std::uint16_t instance, std::uint16_t eventgroup,
                                                                  std::int64_t now_ns) {
    return server_.destinations(instance, eventgroup, now_ns);
  }
  [[nodiscard]] const someip::SdStatistics& statistics() const { return server_.statistics(); }

 private:
  void receive(const UdpSocket& socket, bool by_multicast);
  void send();

  DiscoveryOptions options_;
  DiscoveryEvents events_;
  someip::SdServer server_;
  UdpSocket unicast_;
  UdpSocket multicast_;
  std::vector<std::uint8_t> buffer_;
  std::vector<someip::SdOutgoing> outgoing_;
};

}  // namespace boresight::runtime
