// Received messages of a service discovery client.
#include <algorithm>

#include "services/ingest_gateway/codecs/someip/fault_kinds.hpp"
#include "services/ingest_gateway/core/sd_client.hpp"

namespace boresight::ingest::someip {

namespace {

using recording::Endpoint;

constexpr unsigned kMaxRefusalsDoubling = 5;  // waits of 1, 2, 4 … 32 s
// After a reboot, a server with an offer without time limit must offer again within this time.
constexpr std::int64_t kOfferAfterReboot_ns = 5 * kSecond_ns;
// A server answers within 100 ms, and the Subscribe may have been delayed for as long. A server without an answer after
// this time may not exist: another one that offers the instance replaces it.
constexpr std::int64_t kAnswersWithin_ns = 400'000'000;
// Acks with changing groups must not open and close sockets at their own rate.
constexpr std::int64_t kGroupStays_ns = kSecond_ns;

Fault kind_of(SdFault fault) {
  switch (fault) {
    case SdFault::kTooShort:
    case SdFault::kEntriesLength:
    case SdFault::kOptionsLength:
    case SdFault::kOptionLength:
      return Fault::kWireLength;
    case SdFault::kTooManyEntries:
    case SdFault::kTooManyOptions:
      return Fault::kCapacity;
    case SdFault::kHeader:
    case SdFault::kEntryType:
    case SdFault::kOptionUnknown:
      return Fault::kWireUnknown;
    default:
      return Fault::kWireValue;
  }
}

}  // namespace

void SdClient::entry_fault(SdFault fault) {
  ++statistics_.malformed_entries;
  // One fault per message is enough: a message with 64 bad entries would fill the log.
  if (!reported_entry_fault_) actions_.fault(kind_of(fault), describe(fault));
  reported_entry_fault_ = true;
}

std::int64_t SdClient::take(std::span<const std::uint8_t> datagram, const Endpoint& sender, bool by_multicast,
                            std::int64_t now_ns) {
  MessageReader reader(datagram);
  Message message;
  for (ReadResult result; (result = reader.next(message)) != ReadResult::kEnd;) {
    if (result == ReadResult::kMessage) {
      take_sd(message, sender, by_multicast, now_ns);
    } else if (running_ && link_is_up_) {
      ++statistics_.malformed_messages;
      actions_.fault(kind_of(result), describe(result));
    }
  }
  return tick(now_ns);
}

std::int64_t SdClient::take(const Message& message, const Endpoint& sender, bool by_multicast, std::int64_t now_ns) {
  take_sd(message, sender, by_multicast, now_ns);
  return tick(now_ns);
}

void SdClient::take_sd(const Message& message, const Endpoint& sender, bool by_multicast, std::int64_t now_ns) {
  if (!running_ || !link_is_up_ || message.service != kSdService || message.method != kSdMethod) return;
  ++statistics_.messages;
  reported_entry_fault_ = false;
  if (const SdFault fault = message_.read(message); fault != SdFault::kNone) {
    ++statistics_.malformed_messages;
    actions_.fault(kind_of(fault), describe(fault));
    return;
  }
  // The SD endpoint option replaces the sender's address; an invalid option is ignored.
  Endpoint peer = sender;
  Endpoint stated;
  if (const SdFault fault = message_.sd_endpoint(family(), stated); fault == SdFault::kNone) {
    peer = stated;
  } else if (fault != SdFault::kEndpointMissing) {
    actions_.fault(kind_of(fault), describe(fault));
  }
  take_session(message, peer, by_multicast, now_ns);
  for (const SdEntry& entry : message_.entries()) {
    if (entry.fault != SdFault::kNone) {
      entry_fault(entry.fault);
    } else if (entry.type == EntryType::kOffer) {
      take_offer(entry, peer, now_ns);
    } else if (entry.type == EntryType::kSubscribeAck) {
      take_ack(entry, peer, now_ns);
    } else {
      ++statistics_.foreign_entries;
    }
  }
}

void SdClient::take_session(const Message& message, const Endpoint& peer, bool by_multicast, std::int64_t now_ns) {
  if (message.session == 0) {
    actions_.fault(Fault::kWireValue, "SOME/IP-SD: session id 0: reboots of this server cannot be detected");
    return;
  }
  // Programs on this host that share the SD port look like one peer, but have separate counters, and the client's own
  // Finds come back as well. Only messages of servers count here.
  const auto is_of_server = [](const SdEntry& entry) {
    return entry.type == EntryType::kOffer || entry.type == EntryType::kSubscribeAck;
  };
  const std::span<const SdEntry> entries = message_.entries();
  if (peer.address == local_address_ && std::none_of(entries.begin(), entries.end(), is_of_server)) return;
  SdPeer& known = peer_at(peer, now_ns);
  known.last_heard_ns = now_ns;
  if (known.incoming.take(by_multicast, message.session, message_.reboot_flag(), now_ns)) take_reboot(peer, now_ns);
}

void SdClient::take_reboot(const Endpoint& peer, std::int64_t now_ns) {
  ++statistics_.reboots;
  for (Subscription& s : subscriptions_) {
    if (s.state.phase == Phase::kSeeking || s.state.peer != peer) continue;
    end(s, UnsubscribeReason::kServerReboot);
    forget_refusals(s);
    s.sent = false;
    s.stop_first = true;
    s.offer_expires_ns = std::min(s.offer_expires_ns, after(now_ns, kOfferAfterReboot_ns));
    subscribe_soon(s, now_ns);
  }
}

void SdClient::take_offer(const SdEntry& entry, const Endpoint& peer, std::int64_t now_ns) {
  bool concerns_us = false;
  std::optional<SdFault> endpoint_fault;  // checked at first use
  Endpoint server;
  for (Subscription& s : subscriptions_) {
    const bool is_seeking = s.state.phase == Phase::kSeeking;
    if (s.config.service != entry.service) continue;
    if (s.config.instance != kAnyInstance && s.config.instance != entry.instance) continue;
    concerns_us = true;
    if (!is_seeking && s.state.instance != entry.instance) continue;
    const bool is_anothers = !is_seeking && s.state.peer.address != peer.address;
    if (is_anothers && (entry.ttl_s == 0 || shows_life(s.state.peer, now_ns))) {
      ++statistics_.offers_by_others;
      continue;
    }
    if (entry.ttl_s == 0) {
      if (!is_seeking) lose(s, UnsubscribeReason::kStopOffer);
      continue;
    }
    if (s.config.major != kAnyMajor && s.config.major != entry.major) {
      if (is_seeking) actions_.fault(Fault::kVersionMismatch, "SOME/IP-SD: service offered in another major version");
      continue;
    }
    if (!endpoint_fault) {
      endpoint_fault = message_.endpoint_of(entry, family(), SdMessage::Purpose::kUnicast, server);
      if (*endpoint_fault != SdFault::kNone) entry_fault(*endpoint_fault);
    }
    if (*endpoint_fault == SdFault::kNone) bind(s, entry, peer, server, now_ns);
  }
  if (!concerns_us) {
    ++statistics_.foreign_entries;
  } else {
    ++(entry.ttl_s == 0 ? statistics_.stop_offers : statistics_.offers);
  }
}

bool SdClient::shows_life(const Endpoint& peer, std::int64_t now_ns) const {
  return std::any_of(subscriptions_.begin(), subscriptions_.end(), [&](const Subscription& s) {
    return s.state.phase != Phase::kSeeking && s.state.peer.address == peer.address && now_ns <= s.alive_until_ns;
  });
}

void SdClient::bind(Subscription& s, const SdEntry& entry, const Endpoint& peer, const Endpoint& server,
                    std::int64_t now_ns) {
  SdSubscriptionState& state = s.state;
  if (state.phase == Phase::kSeeking) {
    state.phase = Phase::kSubscribing;
    s.alive_until_ns = after(now_ns, kAnswersWithin_ns);
  } else if (state.peer.address != peer.address) {
    lose(s, UnsubscribeReason::kServerChanged);
    state.phase = Phase::kSubscribing;
    s.alive_until_ns = after(now_ns, kAnswersWithin_ns);
  } else if (state.server != server || state.major != entry.major) {
    end(s, UnsubscribeReason::kServerChanged);
    s.sent = false;
  }
  state.instance = entry.instance;
  state.major = entry.major;
  state.server = server;
  state.peer = peer;
  s.offer_expires_ns = expiry(now_ns, entry.ttl_s);
  subscribe_soon(s, now_ns);
}

void SdClient::take_ack(const SdEntry& entry, const Endpoint& peer, std::int64_t now_ns) {
  const EventgroupId id{entry.service, entry.instance, entry.major, entry.eventgroup, entry.counter};
  const auto found = std::find_if(subscriptions_.begin(), subscriptions_.end(), [&](const Subscription& s) {
    return s.sent && s.state.peer.address == peer.address && id_of(s) == id;
  });
  if (found == subscriptions_.end()) {
    ++statistics_.foreign_entries;
    return;
  }
  Subscription& s = *found;
  if (entry.ttl_s == 0) {
    ++statistics_.refusals;
    actions_.fault(Fault::kLink, "SOME/IP-SD: the server refuses the subscription (Nack)");
    end(s, UnsubscribeReason::kRefused);
    const std::int64_t wait_ns = kSecond_ns << std::min(s.refusals++, kMaxRefusalsDoubling);
    s.refused_until_ns = s.subscribe_due_ns = after(now_ns, wait_ns);
    s.complain_at_ns = kNever;
    s.sent = false;
    return;
  }
  Endpoint group;
  const SdFault fault = message_.endpoint_of(entry, family(), SdMessage::Purpose::kMulticast, group);
  if (fault != SdFault::kNone && fault != SdFault::kEndpointMissing) {
    entry_fault(fault);
    return;
  }
  ++statistics_.acks;
  const std::optional<Endpoint> wanted = fault == SdFault::kNone ? std::optional(group) : std::nullopt;
  if (wanted != s.state.group && now_ns < s.group_stays_until_ns) {
    actions_.fault(Fault::kLink,
                   "SOME/IP-SD: Acks name another multicast group within a second; the first group is kept");
  } else if (wanted != s.state.group) {
    set_group(s, wanted);
    s.group_stays_until_ns = after(now_ns, kGroupStays_ns);
  }
  confirm(s, entry.ttl_s, now_ns);
}

void SdClient::event_received(std::size_t index, std::int64_t now_ns) {
  for (Subscription& s : subscriptions_) {
    if (s.config.index != index || !s.sent) continue;
    if (s.state.phase != Phase::kSubscribed) ++statistics_.acknowledged_by_events;
    confirm(s, s.config.ttl_s, now_ns);
  }
}

}  // namespace boresight::ingest::someip
