// Peers of a service discovery client: session counters of both directions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/common/recording/ip_address.hpp"

namespace boresight::ingest::someip {

/// The client's counter for one receiver (a peer, or the multicast group): 1 … 65535, then 1 again. The reboot flag is
/// set until the first wrap.
class SessionCounter {
 public:
  struct Stamp {
    std::uint16_t session;
    bool reboot_flag;
  };
  [[nodiscard]] Stamp next() {
    const Stamp stamp{next_, reboot_flag_};
    if (next_ == 0xFFFF) {
      next_ = 1;
      reboot_flag_ = false;
    } else {
      ++next_;
    }
    return stamp;
  }

 private:
  std::uint16_t next_ = 1;
  bool reboot_flag_ = true;
};

/// Detects a peer's reboot by the sessions and flags of its messages. Multicast and unicast are separate, as senders
/// count them separately.
class RebootDetector {
 public:
  /// True if this message is the first that shows a reboot. The history of the other kind (multicast or unicast) is
  /// then deleted, as its next message would show the same reboot again. The same session within 10 ms is a copy by the
  /// network, not a reboot.
  [[nodiscard]] bool take(bool by_multicast, std::uint16_t session, bool reboot_flag, std::int64_t now_ns);

 private:
  struct Last {
    bool known = false;
    bool reboot_flag = false;
    std::uint16_t session = 0;
    std::int64_t received_ns = 0;
  };
  std::array<Last, 2> last_{};
};

struct SdPeer {
  recording::Endpoint endpoint;
  std::int64_t last_heard_ns = 0;
  RebootDetector incoming;
  SessionCounter outgoing;
};

/// A fixed number of peers. If the table is full, a new peer replaces the one that is silent for longest and not
/// needed.
class SdPeers {
 public:
  /// `capacity` must exceed the number of peers that are needed at the same time.
  explicit SdPeers(std::size_t capacity) { peers_.reserve(capacity > 0 ? capacity : 1); }

  /// The peer, created if it is new.
  template <typename IsNeeded>
  [[nodiscard]] SdPeer& at(const recording::Endpoint& endpoint, std::int64_t now_ns, const IsNeeded& is_needed) {
    for (SdPeer& peer : peers_) {
      if (peer.endpoint == endpoint) return peer;
    }
    SdPeer fresh;
    fresh.endpoint = endpoint;
    fresh.last_heard_ns = now_ns;
    if (peers_.size() < peers_.capacity()) return peers_.emplace_back(fresh);
    SdPeer* oldest = nullptr;
    bool oldest_is_needed = true;
    for (SdPeer& peer : peers_) {
      const bool needed = is_needed(peer.endpoint);
      const bool before = oldest == nullptr || (oldest_is_needed && !needed) ||
                          (oldest_is_needed == needed && peer.last_heard_ns < oldest->last_heard_ns);
      if (!before) continue;
      oldest = &peer;
      oldest_is_needed = needed;
    }
    ++replaced_;
    *oldest = fresh;
    return *oldest;
  }
  [[nodiscard]] std::size_t size() const { return peers_.size(); }
  [[nodiscard]] std::uint64_t replaced() const { return replaced_; }

 private:
  std::vector<SdPeer> peers_;
  std::uint64_t replaced_ = 0;
};

}  // namespace boresight::ingest::someip
