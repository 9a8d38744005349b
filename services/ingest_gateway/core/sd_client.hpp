// SOME/IP service discovery as a client sees it: finds services, subscribes to their eventgroups and keeps it so.
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

/// One eventgroup that is wanted.
struct SdSubscription {
  std::size_t index = 0;  ///< the caller's number for it
  std::uint16_t service = 0;
  std::uint16_t instance = kAnyInstance;  ///< any: the first that offers
  std::uint8_t major = kAnyMajor;
  std::uint16_t eventgroup = 0;
  std::uint32_t ttl_s = 3;       ///< 1 … 0xFFFFFF (until the next reboot); taken to the nearest of these
  std::uint16_t local_port = 0;  ///< UDP port on which its events are awaited
};

struct SdClientConfig {
  recording::IpAddress local_address;  ///< unicast; its family is that of all endpoints
  recording::Endpoint group;           ///< multicast group and port of service discovery on this network
  std::vector<SdSubscription> subscriptions;
};

enum class UnsubscribeReason : std::uint8_t {
  kStopOffer,        ///< the server withdrew its offer
  kOfferExpired,     ///< the server was not heard within its offer's time to live
  kServerReboot,     ///< the server started again; subscribing anew
  kServerChanged,    ///< the offer names another endpoint or version; subscribing anew
  kRefused,          ///< the server refused the renewal; tried again later
  kNotAcknowledged,  ///< neither Ack nor event within the time to live; subscribing anew
  kLinkDown,
  kStopped,
};

/// What the client wants done. Functions must not call the client.
class SdActions {
 public:
  virtual ~SdActions() = default;
  /// Sends a datagram from the SD port of the client's interface; the bytes are not kept.
  virtual void send(std::span<const std::uint8_t> datagram, const recording::Endpoint& to) = 0;
  /// The server has acknowledged, or its events arrive. `server`: from where they come, by its offer.
  virtual void subscribed(std::size_t index, const recording::Endpoint& server) = 0;
  /// After subscribed(); the client goes on by itself.
  virtual void unsubscribed(std::size_t index, UnsubscribeReason reason) = 0;
  /// Events come to this group and port, from now on.
  virtual void join_multicast(std::size_t index, const recording::Endpoint& group) = 0;
  virtual void leave_multicast(std::size_t index, const recording::Endpoint& group) = 0;
  /// `what` is a constant.
  virtual void fault(Fault fault, std::string_view what) = 0;
};

/// Since construction.
struct SdStatistics {
  std::uint64_t messages = 0;            ///< SD messages that came
  std::uint64_t malformed_messages = 0;  ///< of these, refused whole
  std::uint64_t malformed_entries = 0;   ///< refused entries of others
  std::uint64_t foreign_entries = 0;     ///< of no concern to the client
  std::uint64_t offers = 0, stop_offers = 0, expired_offers = 0;
  std::uint64_t offers_by_others = 0;  ///< of an instance that is already bound to another server
  std::uint64_t acks = 0, refusals = 0, acknowledged_by_events = 0, not_acknowledged = 0;
  std::uint64_t reboots = 0;
  std::uint64_t finds_sent = 0, subscribes_sent = 0, stop_subscribes_sent = 0;  ///< entries
  std::uint64_t subscribes_put_off = 0;                                         ///< wanted more often than allowed
};

/// For status output.
struct SdSubscriptionState {
  enum class Phase : std::uint8_t { kSeeking, kSubscribing, kSubscribed };
  Phase phase = Phase::kSeeking;
  // Of no meaning while seeking:
  std::uint16_t instance = 0;
  std::uint8_t major = 0;
  recording::Endpoint server;  ///< from where the events come
  recording::Endpoint peer;    ///< with which service discovery is done
  std::optional<recording::Endpoint> group;
};

/// One network interface's client. Time is CLOCK_MONOTONIC in nanoseconds, as an argument. Nothing allocates after
/// construction; what the network can make it do is bounded: fixed tables, and at most 10 Subscribes a second for each
/// subscription, whatever arrives.
///
/// Messages are seen by sessions of their sender, endpoints are taken from options: an offer's endpoint need not be
/// where the offer came from. A server that answers
/// keeps its place against others that offer the same instance; one that does not loses it to them. Because another
/// program on this host may share the SD port and receive the Acks meant for us, arriving events count as an Ack.
class SdClient {
 public:
  static constexpr std::int64_t kNever = kNever_ns;
  static constexpr std::size_t kSparePeers = 32;

  SdClient(const SdClientConfig& config, SdActions& actions);

  /// Begins to seek. Returns, like the functions below, when tick() is due at the latest; kNever: not at all.
  std::int64_t start(std::int64_t now_ns);
  /// Withdraws all subscriptions.
  void stop(std::int64_t now_ns);
  void link_down();
  /// Seeks again; a server that went on in between is subscribed to anew. Without link_down() before, what is known is
  /// kept, and its subscriptions are renewed at once.
  std::int64_t link_up(std::int64_t now_ns);
  std::int64_t tick(std::int64_t now_ns);

  /// A datagram that came to the SD port. Messages of other services in it are ignored.
  std::int64_t take(std::span<const std::uint8_t> datagram, const recording::Endpoint& sender, bool by_multicast,
                    std::int64_t now_ns);
  /// One message of it.
  std::int64_t take(const Message& message, const recording::Endpoint& sender, bool by_multicast, std::int64_t now_ns);
  /// An event of this subscription has arrived.
  void event_received(std::size_t index, std::int64_t now_ns);

  [[nodiscard]] const SdStatistics& statistics() const { return statistics_; }
  /// By position in the configuration.
  [[nodiscard]] const SdSubscriptionState& state(std::size_t position) const { return subscriptions_[position].state; }
  [[nodiscard]] std::size_t number_of_peers() const { return peers_.size(); }

 private:
  using Phase = SdSubscriptionState::Phase;
  struct Subscription {
    SdSubscription config;
    std::uint8_t counter = 0;  // tells subscriptions to the same eventgroup apart
    SdSubscriptionState state;
    std::int64_t offer_expires_ns = kNever;
    std::int64_t subscribe_due_ns = kNever;
    std::int64_t next_allowed_ns = std::numeric_limits<std::int64_t>::min();   // not too often
    std::int64_t refused_until_ns = std::numeric_limits<std::int64_t>::min();  // after a Nack
    std::int64_t confirmed_until_ns = kNever;
    std::int64_t complain_at_ns = kNever;  // that there is no Ack
    std::int64_t alive_until_ns = 0;       // until then no other server takes this one's place
    std::int64_t group_stays_until_ns = std::numeric_limits<std::int64_t>::min();
    bool sent = false;        // a Subscribe, since the offer
    bool stop_first = false;  // withdraw what the server may still have of us before subscribing
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
  bool entry_fault_told_ = false;  // of the present message
  std::int64_t seeking_since_ns_ = 0;
  std::size_t next_find_;
};

}  // namespace boresight::ingest::someip
