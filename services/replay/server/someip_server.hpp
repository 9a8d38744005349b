// Serves the Boresight service (interfaces/wire/boresight_service.md) on the network: discovery and events of several
// instances. Single-threaded: works while the caller waits.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/common/runtime/discovery_server.hpp"
#include "services/common/runtime/udp_socket.hpp"
#include "services/replay/core/datagrams.hpp"
#include "services/replay/core/event_encoder.hpp"

namespace boresight::replay {

struct SomeIpOptions {
  std::string interface;             ///< "eth0"
  recording::IpAddress address;      ///< of this machine on that interface
  std::uint16_t first_port = 30600;  ///< instance n sends from first_port + n
  std::optional<recording::Endpoint> event_group;
  recording::Endpoint discovery_group;
  double offer_cycle_s = 1.0;
  double share_s = 0.0;  ///< > 0: time that short messages wait to share a datagram
  int multicast_hops = 1;
  std::uint32_t data_id_base = 0x4253'0000;
};

struct ServerCounts {
  std::uint64_t detection_lists = 0, ego_motions = 0;  ///< sent to at least one subscriber or group
  std::uint64_t unheard = 0;                           ///< events without a subscriber
  std::uint64_t datagrams = 0, bytes = 0;              ///< of events
  std::uint64_t refused = 0;                           ///< datagrams that the kernel rejected
};

class SomeIpServer {
 public:
  /// Opens the sockets (throws std::runtime_error) and begins the initial wait of service discovery.
  SomeIpServer(const SomeIpOptions& options, const std::vector<std::uint16_t>& instances);

  /// The same as stop().
  ~SomeIpServer();
  SomeIpServer(const SomeIpServer&) = delete;
  SomeIpServer& operator=(const SomeIpServer&) = delete;

  /// Sends answers and offers until the monotonic time or a stop signal; at least one pass.
  void serve_until(std::int64_t due_ns);
  /// Sends to all subscribers; false without a subscriber.
  bool send(std::uint16_t number, const RadarScan& scan, const SensorTime& time);
  /// Sends the event as each instance, since clients may subscribe to any of them.
  bool send(const EgoMotion& ego, const SensorTime& time);
  /// Sends waiting messages and withdraws the offers; no events afterwards.
  void stop();

  /// True if a client has subscribed to the detections of at least one instance.
  [[nodiscard]] bool has_subscriber();
  [[nodiscard]] const ServerCounts& counts() const { return counts_; }
  [[nodiscard]] const someip::SdStatistics& discovery() const { return discovery_.statistics(); }

 private:
  struct Instance {
    std::uint16_t number;
    runtime::UdpSocket socket;
    EventEncoder encoder;
    std::map<recording::Endpoint, SharedDatagram> waiting;
  };
  /// Logs only the first malformed datagram of service discovery.
  void report(const recording::IpAddress& from, std::string_view what) const;
  [[nodiscard]] std::span<const recording::Endpoint> destinations(const Instance& instance, std::uint16_t eventgroup);
  void deliver(Instance& instance, std::span<const recording::Endpoint> destinations,
               std::span<const std::uint8_t> message);
  /// Keeps a short message until its datagram is full, or for share_s.
  void share(Instance& instance, const recording::Endpoint& to, std::span<const std::uint8_t> message);
  void send_datagram(const Instance& instance, const recording::Endpoint& to, std::span<const std::uint8_t> datagram);
  void flush();

  SomeIpOptions options_;
  runtime::DiscoveryServer discovery_;
  std::vector<Instance> instances_;
  std::int64_t flush_ns_;
  ServerCounts counts_;
};

}  // namespace boresight::replay
