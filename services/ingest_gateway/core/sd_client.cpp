#include "services/ingest_gateway/core/sd_client.hpp"

#include <algorithm>
#include <array>

namespace boresight::ingest::someip {

namespace {

using recording::Endpoint;

// Times of Find entries after the start; then the client waits for offers.
constexpr std::array<std::int64_t, 4> kFindAt_ns{0, 200'000'000, 600'000'000, 1'400'000'000};
constexpr std::int64_t kBetweenSubscribes_ns = 100'000'000;
// Without Ack, Subscribe is repeated after this time even without a new offer.
constexpr std::int64_t kRepeatUnacknowledged_ns = 2 * kSecond_ns;
constexpr std::int64_t kComplainUnacknowledged_ns = 2 * kSecond_ns;
// Renewals are acknowledged after each offer, or after 2 s at the latest. Without Ack and event for longer, another
// server that offers the same instance replaces this one, whatever the time to live of its offer.
constexpr std::int64_t kSilentFor_ns = 2'500'000'000;

}  // namespace

SdClient::SdClient(const SdClientConfig& config, SdActions& actions)
    : local_address_(config.local_address),
      group_(config.group),
      actions_(actions),
      // Messages of many other peers must not displace peers with subscriptions.
      peers_(kSparePeers + config.subscriptions.size()),
      next_find_(kFindAt_ns.size()) {
  subscriptions_.reserve(config.subscriptions.size());
  for (const SdSubscription& wanted : config.subscriptions) {
    // Subscriptions that may refer to the same eventgroup of the same instance.
    const auto is_alike = [&](const Subscription& s) {
      return s.config.service == wanted.service && s.config.eventgroup == wanted.eventgroup &&
             (s.config.instance == wanted.instance || s.config.instance == kAnyInstance ||
              wanted.instance == kAnyInstance);
    };
    Subscription& s = subscriptions_.emplace_back();
    s.config = wanted;
    s.config.ttl_s = std::clamp<std::uint32_t>(wanted.ttl_s, 1, kForever_s);
    s.counter =
        static_cast<std::uint8_t>(std::count_if(subscriptions_.begin(), subscriptions_.end() - 1, is_alike) & 0x0F);
  }
}

SdMessage::Family SdClient::family() const {
  return local_address_.is_v4() ? SdMessage::Family::kIpv4 : SdMessage::Family::kIpv6;
}

EventgroupId SdClient::id_of(const Subscription& s) const {
  return {s.config.service, s.state.instance, s.state.major, s.config.eventgroup, s.counter};
}

Endpoint SdClient::local_endpoint(const Subscription& s) const {
  return {local_address_, s.config.local_port};
}

SdPeer& SdClient::peer_at(const Endpoint& endpoint, std::int64_t now_ns) {
  return peers_.at(endpoint, now_ns, [this](const Endpoint& candidate) {
    return std::any_of(subscriptions_.begin(), subscriptions_.end(), [&](const Subscription& s) {
      return s.state.phase != Phase::kSeeking && s.state.peer == candidate;
    });
  });
}

// --- Start and stop -------------------------------------------------------------------------------------------

void SdClient::seek_from(std::int64_t now_ns) {
  seeking_since_ns_ = now_ns;
  next_find_ = 0;
}

std::int64_t SdClient::start(std::int64_t now_ns) {
  running_ = true;
  seek_from(now_ns);
  return tick(now_ns);
}

void SdClient::stop(std::int64_t now_ns) {
  if (!running_) return;
  if (link_is_up_) {
    for (const Subscription& s : subscriptions_) {
      if (!s.sent) continue;
      writer_.clear();
      if (!writer_.stop_subscribe(id_of(s), local_endpoint(s))) continue;
      ++statistics_.stop_subscribes_sent;
      send_to_peer(s.state.peer, now_ns);
    }
  }
  for (Subscription& s : subscriptions_) lose(s, UnsubscribeReason::kStopped);
  running_ = false;
}

void SdClient::link_down() {
  link_is_up_ = false;
  for (Subscription& s : subscriptions_) lose(s, UnsubscribeReason::kLinkDown);
}

std::int64_t SdClient::link_up(std::int64_t now_ns) {
  link_is_up_ = true;
  seek_from(now_ns);
  // A server that is still known may have an expired subscription, or an old MAC address of this host.
  for (Subscription& s : subscriptions_) {
    if (s.state.phase != Phase::kSeeking) subscribe_soon(s, now_ns);
  }
  return tick(now_ns);
}

// --- One subscription's state ------------------------------------------------------------------------------------

void SdClient::confirm(Subscription& s, std::uint32_t ttl_s, std::int64_t now_ns) {
  s.confirmed_until_ns = expiry(now_ns, ttl_s);
  s.alive_until_ns = after(now_ns, kSilentFor_ns);
  s.complain_at_ns = kNever;
  forget_refusals(s);
  if (s.state.phase == Phase::kSubscribed) return;
  s.state.phase = Phase::kSubscribed;
  actions_.subscribed(s.config.index, s.state.server);
}

void SdClient::set_group(Subscription& s, const std::optional<Endpoint>& group) {
  if (s.state.group == group) return;
  if (s.state.group) actions_.leave_multicast(s.config.index, *s.state.group);
  s.state.group = group;
  if (group) actions_.join_multicast(s.config.index, *group);
}

/// Ends the subscription; the server is still known.
void SdClient::end(Subscription& s, UnsubscribeReason reason) {
  set_group(s, std::nullopt);
  s.group_stays_until_ns = std::numeric_limits<std::int64_t>::min();
  s.confirmed_until_ns = kNever;
  if (s.state.phase != Phase::kSubscribed) return;
  s.state.phase = Phase::kSubscribing;
  actions_.unsubscribed(s.config.index, reason);
}

/// Forgets the server.
void SdClient::lose(Subscription& s, UnsubscribeReason reason) {
  end(s, reason);
  // After a failure of the link only, the server may still have the old subscription.
  s.stop_first = reason == UnsubscribeReason::kLinkDown && (s.sent || s.stop_first);
  s.state = {};
  s.offer_expires_ns = s.subscribe_due_ns = s.complain_at_ns = kNever;
  s.sent = false;
  forget_refusals(s);
}

void SdClient::forget_refusals(Subscription& s) {
  s.refusals = 0;
  s.refused_until_ns = std::numeric_limits<std::int64_t>::min();
}

void SdClient::subscribe_soon(Subscription& s, std::int64_t now_ns) {
  const std::int64_t allowed_ns = std::max(s.next_allowed_ns, s.refused_until_ns);
  if (allowed_ns > now_ns) ++statistics_.subscribes_put_off;
  s.subscribe_due_ns = std::min(s.subscribe_due_ns, std::max(now_ns, allowed_ns));
}

// --- Time and sending --------------------------------------------------------------------------------------------

std::int64_t SdClient::tick(std::int64_t now_ns) {
  if (!running_ || !link_is_up_) return kNever;
  expire(now_ns);
  send_finds(now_ns);
  send_subscribes(now_ns);
  return next_due();
}

std::int64_t SdClient::next_due() const {
  std::int64_t due = kNever;
  bool is_seeking = false;
  for (const Subscription& s : subscriptions_) {
    is_seeking = is_seeking || s.state.phase == Phase::kSeeking;
    due = std::min({due, s.offer_expires_ns, s.subscribe_due_ns, s.confirmed_until_ns, s.complain_at_ns});
  }
  if (is_seeking && next_find_ < kFindAt_ns.size()) {
    due = std::min(due, after(seeking_since_ns_, kFindAt_ns[next_find_]));
  }
  return due;
}

void SdClient::expire(std::int64_t now_ns) {
  for (Subscription& s : subscriptions_) {
    if (s.state.phase == Phase::kSeeking) continue;
    if (s.offer_expires_ns <= now_ns) {
      ++statistics_.expired_offers;
      lose(s, UnsubscribeReason::kOfferExpired);
      // Offers may have been lost, or another instance may exist: search.
      seek_from(now_ns);
      continue;
    }
    if (s.confirmed_until_ns <= now_ns) {
      ++statistics_.not_acknowledged;
      actions_.fault(Fault::kLink, "SOME/IP-SD: the server does not renew the subscription, and no events arrive");
      end(s, UnsubscribeReason::kNotAcknowledged);
      s.stop_first = true;
      subscribe_soon(s, now_ns);
    }
    if (s.complain_at_ns <= now_ns) {
      ++statistics_.not_acknowledged;
      actions_.fault(Fault::kLink, "SOME/IP-SD: the server does not acknowledge the subscription");
      s.complain_at_ns = kNever;
    }
  }
}

void SdClient::send_finds(std::int64_t now_ns) {
  bool due = false;
  // Missed ones are not caught up.
  while (next_find_ < kFindAt_ns.size() && after(seeking_since_ns_, kFindAt_ns[next_find_]) <= now_ns) {
    due = true;
    ++next_find_;
  }
  if (!due) return;
  const auto send = [this] {
    if (writer_.is_empty()) return;
    const SessionCounter::Stamp stamp = multicast_sessions_.next();
    actions_.send(writer_.finish(stamp.session, stamp.reboot_flag), group_);
    writer_.clear();
  };
  writer_.clear();
  for (auto s = subscriptions_.begin(); s != subscriptions_.end(); ++s) {
    const auto asks_the_same = [&](const Subscription& other) {
      return other.state.phase == Phase::kSeeking && other.config.service == s->config.service &&
             other.config.instance == s->config.instance && other.config.major == s->config.major;
    };
    if (s->state.phase != Phase::kSeeking || std::any_of(subscriptions_.begin(), s, asks_the_same)) continue;
    if (!writer_.find(s->config.service, s->config.instance, s->config.major)) {
      send();
      static_cast<void>(writer_.find(s->config.service, s->config.instance, s->config.major));
    }
    ++statistics_.finds_sent;
  }
  send();
}

void SdClient::send_to_peer(const Endpoint& peer, std::int64_t now_ns) {
  const SessionCounter::Stamp stamp = peer_at(peer, now_ns).outgoing.next();
  actions_.send(writer_.finish(stamp.session, stamp.reboot_flag), peer);
}

void SdClient::send_subscribes(std::int64_t now_ns) {
  const auto is_due = [now_ns](const Subscription& s) {
    return s.state.phase != Phase::kSeeking && s.subscribe_due_ns != kNever && s.subscribe_due_ns <= now_ns;
  };
  // Entries to the same peer share a message if they fit; the others go with the next message.
  for (const Subscription& first : subscriptions_) {
    while (is_due(first)) {
      writer_.clear();
      for (Subscription& s : subscriptions_) {
        if (!is_due(s) || s.state.peer != first.state.peer) continue;
        if (s.stop_first) {
          if (!writer_.stop_subscribe(id_of(s), local_endpoint(s))) break;
          ++statistics_.stop_subscribes_sent;
          s.stop_first = false;
        }
        if (!writer_.subscribe(id_of(s), s.config.ttl_s, local_endpoint(s))) break;
        mark_sent(s, now_ns);
      }
      send_to_peer(first.state.peer, now_ns);
    }
  }
}

void SdClient::mark_sent(Subscription& s, std::int64_t now_ns) {
  ++statistics_.subscribes_sent;
  s.next_allowed_ns = after(now_ns, kBetweenSubscribes_ns);
  const bool is_acknowledged = s.state.phase == Phase::kSubscribed;
  if (!is_acknowledged && !s.sent) s.complain_at_ns = after(now_ns, kComplainUnacknowledged_ns);
  s.sent = true;
  // Each offer of a frequent server is answered; for other servers the timer renews.
  const std::int64_t half_ns = s.config.ttl_s == kForever_s ? kNever : s.config.ttl_s * kSecond_ns / 2;
  s.subscribe_due_ns = after(now_ns, is_acknowledged ? half_ns : std::min(half_ns, kRepeatUnacknowledged_ns));
}

}  // namespace boresight::ingest::someip
