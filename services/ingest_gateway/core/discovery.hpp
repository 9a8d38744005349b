// Service discovery on one network: gives the receiver the endpoint of each source's events.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/core/sd_client.hpp"
#include "services/ingest_gateway/core/sink.hpp"
#include "services/ingest_gateway/core/someip_receiver.hpp"

namespace boresight::ingest {

class Discovery : private someip::SdActions {
 public:
  /// `address` defines the network by local address, interface and discovery group.
  Discovery(const SourceAddress& network, SomeIpReceiver& receiver, Sink& sink);

  [[nodiscard]] bool is_on(const SourceAddress& network) const;
  /// Before prepare(): adds an event; `index` is its number in the receiver.
  void add(std::size_t index, const SourceAddress& address, std::uint16_t eventgroup);
  void prepare();

  /// Begins to search the services. With a recording it only listens and sends nothing.
  void start(std::int64_t now_ns);
  void stop(std::int64_t now_ns);
  /// The network is back: searches missing services without waiting for the next offers.
  void network_is_up(std::int64_t now_ns);
  /// True if the frame belongs to service discovery on this network.
  [[nodiscard]] bool is_for(const recording::Frame& frame) const {
    return frame.destination.port == group_.port || frame.source.port == group_.port;
  }
  void take(const recording::Frame& frame, std::int64_t now_ns);
  void tick(std::int64_t now_ns);
  /// Nothing if the index is that of another network.
  void event_received(std::size_t index, std::int64_t now_ns);

 private:
  void send(std::span<const std::uint8_t> datagram, const recording::Endpoint& to) override;
  void subscribed(std::size_t index, const recording::Endpoint& server) override;
  void unsubscribed(std::size_t index, someip::UnsubscribeReason reason) override;
  void join_multicast(std::size_t index, const recording::Endpoint& group) override;
  void leave_multicast(std::size_t index, const recording::Endpoint& group) override;
  void fault(Fault fault, std::string_view what) override;
  void tell_receiver();

  std::string interface_;
  recording::IpAddress local_;
  recording::Endpoint group_;
  SomeIpReceiver& receiver_;
  Sink& sink_;
  std::vector<someip::SdSubscription> subscriptions_;
  std::optional<someip::SdClient> client_;
};

}  // namespace boresight::ingest
