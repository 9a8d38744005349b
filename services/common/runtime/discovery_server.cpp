#include "services/common/runtime/discovery_server.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "services/common/runtime/clock.hpp"

namespace boresight::runtime {

namespace {

someip::SdServerConfig completed(someip::SdServerConfig config) {
  constexpr std::uint32_t kLeastTtl_s = 3;
  const double cycle_s = static_cast<double>(config.cycle_ns) * 1e-9;
  config.offer_ttl_s = std::max(kLeastTtl_s, static_cast<std::uint32_t>(std::ceil(3.0 * cycle_s)));
  // Random, so that ECUs that are switched on together do not offer at the same time.
  std::random_device random;
  config.initial_wait_ns = std::uniform_int_distribution<std::int64_t>(10'000'000, 100'000'000)(random);
  return config;
}

}  // namespace

DiscoveryServer::DiscoveryServer(DiscoveryOptions options, someip::SdServerConfig config, DiscoveryEvents events)
    : options_(std::move(options)),
      events_(std::move(events)),
      server_(completed(std::move(config))),
      unicast_(
          UdpSocket::bound_to({options_.address, options_.group.port}, options_.interface, options_.multicast_hops)),
      multicast_(UdpSocket::member_of(options_.group, options_.interface)),
      buffer_(65536) {
  server_.start(monotonic_now_ns());
}

void DiscoveryServer::tick(std::int64_t now_ns) {
  server_.tick(now_ns, outgoing_);
  send();
}

void DiscoveryServer::receive() {
  receive(unicast_, false);
  receive(multicast_, true);
}

void DiscoveryServer::receive(const UdpSocket& socket, bool by_multicast) {
  // Bounded, so that many discovery messages do not delay the caller.
  constexpr int kDatagramsPerTurn = 32;
  for (int i = 0; i < kDatagramsPerTurn; ++i) {
    recording::Endpoint from;
    const auto datagram = socket.receive(buffer_, from);
    if (!datagram) return;
    const bool own = from.address == options_.address && from.port == options_.group.port;
    if (own && by_multicast) continue;
    const auto problem = server_.receive(monotonic_now_ns(), *datagram, from, by_multicast, outgoing_);
    if (problem && events_.on_problem) events_.on_problem(from.address, *problem);
    send();
    if (!events_.on_new_subscriber) continue;
    for (const auto& subscriber : server_.new_subscribers()) events_.on_new_subscriber(subscriber);
  }
}

void DiscoveryServer::send() {
  for (const someip::SdOutgoing& message : outgoing_) {
    // If the link is down, the message is lost; the next offer repeats its content.
    static_cast<void>(unicast_.send(message.to.value_or(options_.group), message.message));
  }
  outgoing_.clear();
}

void DiscoveryServer::stop() {
  server_.stop(outgoing_);
  send();
}

}  // namespace boresight::runtime
