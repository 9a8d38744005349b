#include "services/common/someip/sd_server.hpp"

#include <algorithm>
#include <utility>

namespace boresight::someip {

namespace {

constexpr std::uint32_t kTtlForever = 0xFFFFFF;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

bool same_subscriber(std::uint8_t counter, const recording::Endpoint& endpoint, const SdEntry& entry) {
  return counter == entry.counter && endpoint == entry.endpoint;
}

}  // namespace

SdServer::SdServer(SdServerConfig config) : config_(std::move(config)) {}

bool SdServer::asks_for(const SdEntry& entry, std::uint16_t instance) const {
  return entry.type == static_cast<std::uint8_t>(SdEntryType::kFindService) && entry.service == config_.service.id &&
         (entry.instance == 0xFFFF || entry.instance == instance) &&
         (entry.major == 0xFF || entry.major == config_.service.major) &&
         (entry.minor == 0xFFFF'FFFF || entry.minor == config_.service.minor);
}

SdWriter::Service SdServer::offered(std::uint16_t instance) const {
  return {config_.service.id, instance, config_.service.major, config_.service.minor};
}

void SdServer::start(std::int64_t now_ns) {
  running_ = true;
  offers_sent_ = 0;
  next_offer_ns_ = now_ns + config_.initial_wait_ns;
}

void SdServer::stop(std::vector<SdOutgoing>& out) {
  // Nothing to withdraw before the first offer.
  if (running_ && offers_sent_ > 0) offer_all(0, out);
  running_ = false;
  next_offer_ns_ = kNever;
  subscriptions_.clear();
}

void SdServer::tick(std::int64_t now_ns, std::vector<SdOutgoing>& out) {
  expire(now_ns);
  if (!running_ || now_ns < next_offer_ns_) return;
  offer_all(config_.offer_ttl_s, out);
  const std::int64_t wait_ns =
      offers_sent_ < config_.repetitions ? config_.repetition_base_ns << offers_sent_ : config_.cycle_ns;
  if (offers_sent_ <= config_.repetitions) ++offers_sent_;
  // A missed cycle is not caught up, for example after suspension of the machine.
  next_offer_ns_ = std::max(next_offer_ns_ + wait_ns, now_ns + wait_ns / 2);
}

void SdServer::offer_all(std::uint32_t ttl_s, std::vector<SdOutgoing>& out) {
  SdWriter writer;
  for (const OfferedInstance& entry : config_.instances) {
    writer.offer(offered(entry.instance), ttl_s, entry.endpoint);
  }
  const std::uint16_t session = multicast_session_.take();
  out.push_back({std::nullopt, writer.finish(session, !multicast_session_.wrapped())});
}

std::optional<std::string_view> SdServer::receive(std::int64_t now_ns, std::span<const std::uint8_t> datagram,
                                                  const recording::Endpoint& from, bool by_multicast,
                                                  std::vector<SdOutgoing>& out) {
  new_subscribers_.clear();
  if (!running_) return std::nullopt;
  expire(now_ns);
  while (!datagram.empty()) {
    constexpr std::size_t kLengthEnd = 8;
    std::size_t bytes = datagram.size();
    if (bytes >= kLengthEnd) {
      const std::size_t length = static_cast<std::size_t>(datagram[4]) << 24 |
                                 static_cast<std::size_t>(datagram[5]) << 16 |
                                 static_cast<std::size_t>(datagram[6]) << 8 | datagram[7];
      // read_sd() detects a length beyond the datagram.
      bytes = std::min(bytes, kLengthEnd + length);
    }
    if (const auto problem = read_sd(datagram.first(bytes), received_)) {
      ++statistics_.malformed;
      return problem;
    }
    take_message(received_, now_ns, from, by_multicast, out);
    datagram = datagram.subspan(bytes);
  }
  return std::nullopt;
}

SdServer::Peer& SdServer::peer(const recording::Endpoint& from, std::int64_t now_ns) {
  if (peers_.size() >= kMaxPeers && !peers_.contains(from)) {
    peers_.erase(std::min_element(peers_.begin(), peers_.end(),
                                  [](const auto& a, const auto& b) { return a.second.heard_ns < b.second.heard_ns; }));
  }
  Peer& known = peers_[from];
  known.heard_ns = now_ns;
  return known;
}

void SdServer::take_message(const SdMessage& message, std::int64_t now_ns, const recording::Endpoint& from,
                            bool by_multicast, std::vector<SdOutgoing>& out) {
  Peer& sender = peer(from, now_ns);
  Heard& last = by_multicast ? sender.multicast : sender.unicast;
  // PRS_SOMEIPServiceDiscoveryProtocol, "Reboot detection": the flag appears, or stays and the session does not grow.
  const bool rebooted = last.any && message.reboot && (!last.reboot || last.session >= message.session);
  last = {true, message.reboot, message.session};
  if (rebooted) {
    ++statistics_.client_reboots;
    std::erase_if(subscriptions_, [&](const Subscription& s) { return s.client == from.address; });
  }

  const auto entries = std::span(message.entries).first(message.number_of_entries);
  SdWriter answer;
  answer_finds(entries, answer);
  for (const SdEntry& entry : entries) {
    // The protocol does not allow a subscription by multicast; any server may be its destination.
    if (by_multicast || entry.type != static_cast<std::uint8_t>(SdEntryType::kSubscribeEventgroup)) continue;
    take_subscription(entry, now_ns, from, answer);
  }
  if (answer.empty()) return;
  const std::uint16_t session = sender.sent.take();
  out.push_back({from, answer.finish(session, !sender.sent.wrapped())});
}

void SdServer::answer_finds(std::span<const SdEntry> entries, SdWriter& answer) const {
  if (offers_sent_ == 0) return;
  // Each instance at most once for any number of entries, so that an answer is never larger than an offer.
  for (const OfferedInstance& own : config_.instances) {
    const bool wanted = std::any_of(entries.begin(), entries.end(),
                                    [&](const SdEntry& entry) { return asks_for(entry, own.instance); });
    if (wanted) answer.offer(offered(own.instance), config_.offer_ttl_s, own.endpoint);
  }
}

bool SdServer::serves(std::uint16_t instance) const {
  return std::any_of(config_.instances.begin(), config_.instances.end(),
                     [instance](const OfferedInstance& offered) { return offered.instance == instance; });
}

void SdServer::take_subscription(const SdEntry& entry, std::int64_t now_ns, const recording::Endpoint& from,
                                 SdWriter& answer) {
  if (entry.ttl_s == 0) {
    unsubscribe(entry, from);
    return;
  }
  const bool accepted = subscribe(entry, now_ns, from);
  ++(accepted ? statistics_.acknowledged : statistics_.refused);
  answer.acknowledge(entry, accepted ? entry.ttl_s : 0, accepted ? config_.event_group : std::nullopt);
}

bool SdServer::subscribe(const SdEntry& entry, std::int64_t now_ns, const recording::Endpoint& from) {
  const std::vector<std::uint16_t>& eventgroups = config_.service.eventgroups;
  const bool known = entry.service == config_.service.id && serves(entry.instance) &&
                     entry.major == config_.service.major &&
                     std::find(eventgroups.begin(), eventgroups.end(), entry.eventgroup) != eventgroups.end();
  if (!known || !entry.endpoint) return false;
  const std::int64_t expires_ns =
      entry.ttl_s == kTtlForever ? kNever : now_ns + static_cast<std::int64_t>(entry.ttl_s) * kSecond_ns;
  std::size_t others = 0;
  for (Subscription& s : subscriptions_) {
    if (s.instance != entry.instance || s.eventgroup != entry.eventgroup) continue;
    if (s.client == from.address && same_subscriber(s.counter, s.endpoint, entry)) {
      s.expires_ns = expires_ns;
      return true;
    }
    ++others;
  }
  if (others >= config_.max_subscribers) return false;
  subscriptions_.push_back(
      {entry.instance, entry.eventgroup, entry.counter, from.address, *entry.endpoint, expires_ns});
  new_subscribers_.push_back({entry.instance, entry.eventgroup, *entry.endpoint});
  return true;
}

void SdServer::unsubscribe(const SdEntry& entry, const recording::Endpoint& from) {
  std::erase_if(subscriptions_, [&](const Subscription& s) {
    return entry.service == config_.service.id && s.instance == entry.instance && s.eventgroup == entry.eventgroup &&
           s.client == from.address && same_subscriber(s.counter, s.endpoint, entry);
  });
}

void SdServer::expire(std::int64_t now_ns) {
  statistics_.expired +=
      std::erase_if(subscriptions_, [now_ns](const Subscription& s) { return s.expires_ns <= now_ns; });
}

std::span<const recording::Endpoint> SdServer::destinations(std::uint16_t instance, std::uint16_t eventgroup,
                                                            std::int64_t now_ns) {
  destinations_.clear();
  for (const Subscription& s : subscriptions_) {
    if (s.instance != instance || s.eventgroup != eventgroup || s.expires_ns <= now_ns) continue;
    const recording::Endpoint& to = config_.event_group ? *config_.event_group : s.endpoint;
    if (std::find(destinations_.begin(), destinations_.end(), to) == destinations_.end()) destinations_.push_back(to);
  }
  return destinations_;
}

}  // namespace boresight::someip
