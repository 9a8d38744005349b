#include "services/ingest_gateway/core/discovery.hpp"

#include <algorithm>

#include "interfaces/wire/boresight_service.hpp"

namespace boresight::ingest {

namespace wire_service = wire::boresight_service;

Discovery::Discovery(const SourceAddress& network, SomeIpReceiver& receiver, Sink& sink)
    : interface_(network.interface),
      local_(recording::ip_or_unspecified(network.address)),
      group_{recording::ip_or_unspecified(network.discovery_address), network.discovery_port},
      receiver_(receiver),
      sink_(sink) {}

bool Discovery::is_on(const SourceAddress& network) const {
  return network.interface == interface_ && recording::ip_or_unspecified(network.address) == local_ &&
         recording::Endpoint{recording::ip_or_unspecified(network.discovery_address), network.discovery_port} == group_;
}

void Discovery::add(std::size_t index, const SourceAddress& address, std::uint16_t eventgroup) {
  subscriptions_.push_back({.index = index,
                            .service = wire_service::kServiceId,
                            .instance = address.instance,
                            .major = wire_service::kMajorVersion,
                            .eventgroup = eventgroup,
                            .ttl_s = wire_service::discovery::kOfferTtl_s,
                            .local_port = address.port});
}

void Discovery::prepare() {
  client_.emplace(someip::SdClientConfig{.local_address = local_, .group = group_, .subscriptions = subscriptions_},
                  static_cast<someip::SdActions&>(*this));
}

void Discovery::start(std::int64_t now_ns) {
  client_->start(now_ns);
}

void Discovery::stop(std::int64_t now_ns) {
  client_->stop(now_ns);
  tell_receiver();
}

void Discovery::network_is_up(std::int64_t now_ns) {
  client_->link_up(now_ns);
  tell_receiver();
}

void Discovery::take(const recording::Frame& frame, std::int64_t now_ns) {
  // Ignores copies of the gateway's own multicast.
  if (frame.source == recording::Endpoint{local_, group_.port}) return;
  client_->take(frame.payload, frame.source, frame.destination.address.is_multicast(), now_ns);
  tell_receiver();
}

void Discovery::tick(std::int64_t now_ns) {
  client_->tick(now_ns);
  tell_receiver();
}

void Discovery::event_received(std::size_t index, std::int64_t now_ns) {
  const auto is_ours = [index](const someip::SdSubscription& s) { return s.index == index; };
  if (std::any_of(subscriptions_.begin(), subscriptions_.end(), is_ours)) client_->event_received(index, now_ns);
}

void Discovery::tell_receiver() {
  // As soon as the server is known, before its Ack: the first events may arrive before the Ack, and the Ack may go to
  // another stack of this host.
  for (std::size_t i = 0; i < subscriptions_.size(); ++i) {
    const someip::SdSubscriptionState& state = client_->state(i);
    const bool known = state.phase != someip::SdSubscriptionState::Phase::kSeeking;
    receiver_.set_server(subscriptions_[i].index, known ? std::optional(state.server) : std::nullopt);
  }
}

void Discovery::send(std::span<const std::uint8_t> datagram, const recording::Endpoint& to) {
  recording::Frame frame;
  frame.kind = recording::FrameKind::kUdp;
  frame.source = {local_, group_.port};
  frame.destination = to;
  frame.payload = datagram;
  sink_.send(frame);
}

void Discovery::subscribed(std::size_t, const recording::Endpoint&) {}

void Discovery::unsubscribed(std::size_t index, someip::UnsubscribeReason reason) {
  using Reason = someip::UnsubscribeReason;
  switch (reason) {
    case Reason::kStopOffer:
      receiver_.fault(index, Fault::kLink, "SOME/IP: the server withdrew its offer");
      break;
    case Reason::kOfferExpired:
      receiver_.fault(index, Fault::kLink, "SOME/IP: the server's offer expired without a new one");
      break;
    case Reason::kServerReboot:
      receiver_.forget_sequence(index);
      receiver_.fault(index, Fault::kLink, "SOME/IP: the server restarted; subscribing again");
      break;
    case Reason::kServerChanged:
      receiver_.fault(index, Fault::kLink, "SOME/IP: the server's endpoint changed; subscribing again");
      break;
    case Reason::kRefused:
      receiver_.fault(index, Fault::kLink, "SOME/IP: the server refused the subscription");
      break;
    case Reason::kNotAcknowledged:
      receiver_.fault(index, Fault::kLink, "SOME/IP: neither acknowledgement nor events; subscribing again");
      break;
    case Reason::kLinkDown:
    case Reason::kStopped:
      break;
  }
}

void Discovery::join_multicast(std::size_t, const recording::Endpoint& group) {
  sink_.join(group, interface_);
}

void Discovery::leave_multicast(std::size_t, const recording::Endpoint& group) {
  sink_.leave(group, interface_);
}

void Discovery::fault(Fault fault, std::string_view what) {
  sink_.fault(fault, what, 0);
}

}  // namespace boresight::ingest
