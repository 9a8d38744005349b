// The client's side of SOME/IP service discovery: finds services, subscribes to their eventgroups and renews.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "interfaces/messages/service_status.hpp"
#include "services/common/recording/ip_address.hpp"
#include "services/common/someip/message.hpp"
#include "services/ingest_gateway/codecs/someip/sd.hpp"
#include "services/ingest_gateway/codecs/someip/sd_writer.hpp"
#include "services/ingest_gateway/core/sd_peers.hpp"
#include "services/ingest_gateway/core/sd_time.hpp"

namespace boresight::ingest::someip {

/// One required eventgroup.
struct SdSubscription {
  std::size_t index = 0;  ///< the caller's number of this subscription
  std::uint16_t service = 0;
  std::uint16_t instance = kAnyInstance;  ///< any: the first offered one
  std::uint8_t major = kAnyMajor;
  std::uint16_t eventgroup = 0;
  std::uint32_t ttl_s = 3;       ///< 1 … 0xFFFFFF (until the next reboot); other values are clamped
  std::uint16_t local_port = 0;  ///< UDP port for its events
};

struct SdClientConfig {
  recording::IpAddress local_address;  ///< unicast; all endpoints have the same family
  recording::Endpoint group;           ///< multicast group and port of service discovery on this network
  std::vector<SdSubscription> subscriptions;
};

enum class UnsubscribeReason : std::uint8_t {
  kStopOffer,        ///< the server withdrew its offer
  kOfferExpired,     ///< no message of the server within its offer's time to live
  kServerReboot,     ///< the server restarted; subscribing again
  kServerChanged,    ///< the offer names another endpoint or version; subscribing again
  kRefused,          ///< the server refused the renewal; repeated later
  kNotAcknowledged,  ///< neither Ack nor event within the time to live; subscribing again
  kLinkDown,
  kStopped,
};

/// Actions that the client requests. Functions must not call the client.
class SdActions {
 public:
  virtual ~SdActions() = default;
  /// Sends a datagram from the SD port of the client's interface; the bytes are valid only during the call.
  virtual void send(std::span<const std::uint8_t> datagram, const recording::Endpoint& to) = 0;
  /// The server has acknowledged, or its events arrive. `server`: the source of the events, from its offer.
  virtual void subscribed(std::size_t index, const recording::Endpoint& server) = 0;
  /// After subscribed(); the client continues by itself.
  virtual void unsubscribed(std::size_t index, UnsubscribeReason reason) = 0;
  /// Events are sent to this group and port from now on.
  virtual void join_multicast(std::size_t index, const recording::Endpoint& group) = 0;
  virtual void leave_multicast(std::size_t index, const recording::Endpoint& group) = 0;
  /// `what` is a constant.
  virtual void fault(Fault fault, std::string_view what) = 0;
};

/// Counters since construction.
struct SdStatistics {
  std::uint64_t messages = 0;            ///< received SD messages
  std::uint64_t malformed_messages = 0;  ///< of these, rejected
  std::uint64_t malformed_entries = 0;   ///< rejected entries of other messages
  std::uint64_t foreign_entries = 0;     ///< of other services
  std::uint64_t offers = 0, stop_offers = 0, expired_offers = 0;
  std::uint64_t offers_by_others = 0;  ///< of an instance that another server already provides
  std::uint64_t acks = 0, refusals = 0, acknowledged_by_events = 0, not_acknowledged = 0;
  std::uint64_t reboots = 0;
  std::uint64_t finds_sent = 0, subscribes_sent = 0, stop_subscribes_sent = 0;  ///< entries
  std::uint64_t subscribes_put_off = 0;                                         ///< delayed by the limit of their rate
};

/// State for output.
struct SdSubscriptionState {
  enum class Phase : std::uint8_t { kSeeking, kSubscribing, kSubscribed };
  Phase phase = Phase::kSeeking;
  // Without meaning while seeking:
  std::uint16_t instance = 0;
  std::uint8_t major = 0;
  recording::Endpoint server;  ///< source of the events
  recording::Endpoint peer;    ///< partner in service discovery
  std::optional<recording::Endpoint> group;
};

/// The client of one network interface. Time is CLOCK_MONOTONIC in nanoseconds, as an argument. Nothing allocates after
/// construction. Work is bounded for all input: fixed tables, and at most 10 Subscribes per second and subscription.
///
/// Reboots are detected by the sessions of each sender. Endpoints come from options: an offer's endpoint may differ
/// from the sender of the offer. A server that answers keeps its subscription if others offer the same instance; a
/// server that does not answer is replaced by another one. Another program on this host may share the SD port and
/// receive the Acks for this client, so arriving events count as an Ack.
class SdClient {
 public:
  static constexpr std::int64_t kNever = kNever_ns;
  static constexpr std::size_t kSparePeers = 32;

  SdClient(const SdClientConfig& config, SdActions& actions);

  /// Begins to seek. Like the functions below, returns the latest time of the next tick(); kNever: no tick needed.
  std::int64_t start(std::int64_t now_ns);
  /// Withdraws all subscriptions.
  void stop(std::int64_t now_ns);
  void link_down();
  /// Seeks again, and subscribes again to a server that is still running. Without link_down() before, known servers are
  /// kept and their subscriptions renewed at once.
  std::int64_t link_up(std::int64_t now_ns);
  std::int64_t tick(std::int64_t now_ns);

  /// A datagram to the SD port. Messages of other services in it are ignored.
  std::int64_t take(std::span<const std::uint8_t> datagram, const recording::Endpoint& sender, bool by_multicast,
                    std::int64_t now_ns);
  /// One message of such a datagram.
  std::int64_t take(const Message& message, const recording::Endpoint& sender, bool by_multicast, std::int64_t now_ns);
  /// An event of this subscription has arrived.
  void event_received(std::size_t index, std::int64_t now_ns);

  [[nodiscard]] const SdStatistics& statistics() const { return statistics_; }
  /// By index in the configuration.
  [[nodiscard]] const SdSubscriptionState& state(std::size_t position) const { return subscriptions_[position].state; }
  [[nodiscard]] std::size_t number_of_peers() const { return peers_.size(); }

 private:
  using Phase = SdSubscriptionState::Phase;
  struct Subscription {
    SdSubscription config;
    std::uint8_t counter = 0;  // distinguishes subscriptions to the same eventgroup
    SdSubscriptionState state;
    std::int64_t offer_expires_ns = kNever;
    std::int64_t subscribe_due_ns = kNever;
    std::int64_t next_allowed_ns = std::numeric_limits<std::int64_t>::min();   // limits the rate
    std::int64_t refused_until_ns = std::numeric_limits<std::int64_t>::min();  // after a Nack
    std::int64_t confirmed_until_ns = kNever;
    std::int64_t complain_at_ns = kNever;  // time of the report of a missing Ack
    std::int64_t alive_until_ns = 0;       // until then no other server replaces this one
    std::int64_t group_stays_until_ns = std::numeric_limits<std::int64_t>::min();
    bool sent = false;        // a Subscribe was sent since the offer
    bool stop_first = false;  // end a possible old subscription before subscribing
    unsigned refusals = 0;
  };

  void take_sd(const Message& message, const recording::Endpoint& sender, bool by_multicast, std::int64_t now_ns);
  void take_session(const Message& message, const recording::Endpoint& peer, bool by_multicast, std::int64_t now_ns);
  void take_offer(const SdEntry& entry, const recording::Endpoint& peer, std::int64_t now_ns);
  void take_ack(const SdEntry& entry, const recording::Endpoint& peer, std::int64_t now_ns);
  void take_reboot(const recording::Endpoint& peer, std::int64_t now_ns);
  [[nodiscard]] bool shows_life(const recording::Endpoint& peer, std::int64_t now_ns) const;
  void bind(Subscription& s, const SdEntry& entry, const recording::Endpoint& peer, const recording::Endpoint& server,
            std::int64_t now_ns);
  void confirm(Subscription& s, std::uint32_t ttl_s, std::int64_t now_ns);
  void set_group(Subscription& s, const std::optional<recording::Endpoint>& group);
  void end(Subscription& s, UnsubscribeReason reason);
  void lose(Subscription& s, UnsubscribeReason reason);
  static void forget_refusals(Subscription& s);
  void subscribe_soon(Subscription& s, std::int64_t now_ns);

  void expire(std::int64_t now_ns);
  void send_finds(std::int64_t now_ns);
  void send_subscribes(std::int64_t now_ns);
  void mark_sent(Subscription& s, std::int64_t now_ns);
  void send_to_peer(const recording::Endpoint& peer, std::int64_t now_ns);
  void seek_from(std::int64_t now_ns);
  [[nodiscard]] std::int64_t next_due() const;
  [[nodiscard]] SdPeer& peer_at(const recording::Endpoint& endpoint, std::int64_t now_ns);
  [[nodiscard]] EventgroupId id_of(const Subscription& s) const;
  [[nodiscard]] recording::Endpoint local_endpoint(const Subscription& s) const;
  [[nodiscard]] SdMessage::Family family() const;
  void entry_fault(SdFault fault);

  recording::IpAddress local_address_;
  recording::Endpoint group_;
  SdActions& actions_;
  std::vector<Subscription> subscriptions_;
  SdPeers peers_;
  SessionCounter multicast_sessions_;
  SdMessage message_;
  SdWriter writer_;
  SdStatistics statistics_;
  bool running_ = false;
  bool link_is_up_ = true;
  bool reported_entry_fault_ = false;  // of the current message
  std::int64_t seeking_since_ns_ = 0;
  std::size_t next_find_;
};

}  // namespace boresight::ingest::someip
