// The server's side of SOME/IP service discovery: offers, answers, subscriptions (interfaces/wire/boresight_service.md,
// 5), for one service in one or several instances. Independent of sockets and clocks: datagrams and times are
// arguments, answers are return values.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "services/common/recording/ip_address.hpp"
#include "services/common/someip/sd_message.hpp"
#include "services/common/someip/session_counter.hpp"

namespace boresight::someip {

struct OfferedInstance {
  std::uint16_t instance = 1;
  recording::Endpoint endpoint;  ///< source of its events and destination of requests
};

/// The service that every instance offers.
struct OfferedService {
  std::uint16_t id = 0;
  std::uint8_t major = 1;
  std::uint32_t minor = 0;
  std::vector<std::uint16_t> eventgroups;  ///< subscriptions to others are refused
};

struct SdServerConfig {
  OfferedService service;
  std::vector<OfferedInstance> instances;
  std::optional<recording::Endpoint> event_group;  ///< destination of events instead of the subscribers' endpoints
  std::int64_t initial_wait_ns = 50'000'000;       ///< random between 10 and 100 ms, drawn by the caller
  std::int64_t repetition_base_ns = 200'000'000;   ///< doubles with each repetition
  int repetitions = 3;
  std::int64_t cycle_ns = 1'000'000'000;
  std::uint32_t offer_ttl_s = 3;
  std::size_t max_subscribers = 16;  ///< per eventgroup and instance
};

struct SdOutgoing {
  std::optional<recording::Endpoint> to;  ///< nothing: the multicast group of discovery
  std::vector<std::uint8_t> message;
};

struct SdStatistics {
  std::uint64_t malformed = 0;  ///< rejected messages
  std::uint64_t acknowledged = 0;
  std::uint64_t refused = 0;
  std::uint64_t expired = 0;
  std::uint64_t client_reboots = 0;
};

class SdServer {
 public:
  explicit SdServer(SdServerConfig config);

  /// The first offer follows after the initial wait.
  void start(std::int64_t now_ns);
  /// Withdraws all offers and ends all subscriptions.
  void stop(std::vector<SdOutgoing>& out);

  /// Time of the next call of tick(); never before start() and after stop().
  [[nodiscard]] std::int64_t next_due_ns() const { return next_offer_ns_; }
  /// Returns the offers that are due; ends subscriptions without renewal.
  void tick(std::int64_t now_ns, std::vector<SdOutgoing>& out);

  /// One datagram to the discovery port, with one or several messages. Returns its fault, if any.
  std::optional<std::string_view> receive(std::int64_t now_ns, std::span<const std::uint8_t> datagram,
                                          const recording::Endpoint& from, bool by_multicast,
                                          std::vector<SdOutgoing>& out);

  /// Destinations of an eventgroup's events: the multicast group, or the subscribers' endpoints, each once; empty
  /// without subscribers. Valid until the next call of another function.
  [[nodiscard]] std::span<const recording::Endpoint> destinations(std::uint16_t instance, std::uint16_t eventgroup,
                                                                  std::int64_t now_ns);
  /// New subscriptions of the last receive(), without renewals: a field sends them its value.
  struct NewSubscriber {
    std::uint16_t instance;
    std::uint16_t eventgroup;
    recording::Endpoint endpoint;
  };
  [[nodiscard]] std::span<const NewSubscriber> new_subscribers() const { return new_subscribers_; }
  [[nodiscard]] const SdStatistics& statistics() const { return statistics_; }

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  static constexpr std::size_t kMaxPeers = 256;

  struct Subscription {
    std::uint16_t instance;
    std::uint16_t eventgroup;
    std::uint8_t counter;
    recording::IpAddress client;
    recording::Endpoint endpoint;
    std::int64_t expires_ns;
  };
  /// Last session id and flag from one sender, for detection of its reboot.
  struct Heard {
    bool any = false;
    bool reboot = false;
    std::uint16_t session = 0;
  };
  struct Peer {
    Heard unicast, multicast;
    SessionCounter sent;
    std::int64_t heard_ns = 0;
  };

  void take_message(const SdMessage& message, std::int64_t now_ns, const recording::Endpoint& from, bool by_multicast,
                    std::vector<SdOutgoing>& out);
  void answer_finds(std::span<const SdEntry> entries, SdWriter& answer) const;
  void take_subscription(const SdEntry& entry, std::int64_t now_ns, const recording::Endpoint& from, SdWriter& answer);
  [[nodiscard]] bool subscribe(const SdEntry& entry, std::int64_t now_ns, const recording::Endpoint& from);
  void unsubscribe(const SdEntry& entry, const recording::Endpoint& from);
  void expire(std::int64_t now_ns);
  void offer_all(std::uint32_t ttl_s, std::vector<SdOutgoing>& out);
  [[nodiscard]] bool asks_for(const SdEntry& entry, std::uint16_t instance) const;
  [[nodiscard]] SdWriter::Service offered(std::uint16_t instance) const;
  [[nodiscard]] bool serves(std::uint16_t instance) const;
  [[nodiscard]] Peer& peer(const recording::Endpoint& from, std::int64_t now_ns);

  SdServerConfig config_;
  std::int64_t next_offer_ns_ = kNever;
  int offers_sent_ = 0;
  bool running_ = false;
  SessionCounter multicast_session_;
  std::map<recording::Endpoint, Peer> peers_;
  std::vector<Subscription> subscriptions_;
  std::vector<recording::Endpoint> destinations_;
  std::vector<NewSubscriber> new_subscribers_;
  SdMessage received_;
  SdStatistics statistics_;
};

}  // namespace boresight::someip
