// An end-of-line station at the other end of the cable. It uses the gateway's client for service discovery, which
// shares no code with the server. Its requests follow the offsets of the definition.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "services/common/runtime/udp_socket.hpp"
#include "services/ingest_gateway/codecs/someip/sd.hpp"
#include "services/ingest_gateway/codecs/someip/sd_writer.hpp"
#include "tests/system/harness/two_hosts.hpp"
#include "tests/unit/alignment_estimator/station/station_client.hpp"

namespace boresight::calibration_station {

namespace service = wire::calibration_service;
using alignment::station::test::Answer;
using alignment::station::test::Bytes;
using recording::Endpoint;

/// An offer or the answer to a subscription.
struct Heard {
  ingest::someip::EntryType type;
  std::uint16_t service, instance;
  std::uint32_t ttl_s;
  std::optional<Endpoint> endpoint;
  bool by_multicast;
};

/// The station's part in service discovery.
class Finder {
 public:
  explicit Finder(const network::TwoHosts& hosts);
  void find();
  /// Subscribes to the state's events, with a port of the station as destination.
  void subscribe(std::uint16_t eventgroup, std::uint16_t port, std::uint32_t ttl_s);
  void forget() { heard_.clear(); }
  /// Received entries of the calibration service since forget(), after reading the sockets.
  [[nodiscard]] const std::vector<Heard>& heard();
  /// The first such entry within the time.
  [[nodiscard]] std::optional<Heard> wait_for(ingest::someip::EntryType type, double seconds, bool stop = false);

 private:
  void read(const runtime::UdpSocket& socket, bool by_multicast);
  std::unique_ptr<runtime::UdpSocket> unicast_, multicast_;
  ingest::someip::SdWriter writer_;
  std::uint16_t multicast_session_ = 0, unicast_session_ = 0;
  std::vector<Heard> heard_;
};

class Station {
 public:
  Station(const network::TwoHosts& hosts, std::uint16_t client, const Endpoint& ecu);

  /// Sends a request, repeated every 0.5 s with the same session; fails the test and returns zeros after 3 s.
  Answer ask(service::Method method, const Bytes& payload);
  void send(const Bytes& datagram);
  /// The next datagram to the station's port.
  [[nodiscard]] std::optional<Answer> receive(double seconds);
  [[nodiscard]] std::uint16_t client() const { return client_; }
  [[nodiscard]] std::uint16_t next_session() { return ++session_; }

  [[nodiscard]] Answer state() { return ask(service::Method::kGetState, {}); }
  [[nodiscard]] Answer result() { return ask(service::Method::kGetResult, {}); }

 private:
  std::uint16_t client_;
  Endpoint ecu_;
  std::unique_ptr<runtime::UdpSocket> socket_;
  std::uint16_t session_ = 0;
};

/// Receiver of events.
class EventPort {
 public:
  EventPort(const network::TwoHosts& hosts, std::uint16_t port);
  [[nodiscard]] std::optional<Answer> next(double seconds);

 private:
  std::unique_ptr<runtime::UdpSocket> socket_;
};

}  // namespace boresight::calibration_station
