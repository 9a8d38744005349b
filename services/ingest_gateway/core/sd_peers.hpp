// What a service discovery client remembers of those it talks with: session counters of both directions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/common/recording/ip_address.hpp"

namespace boresight::ingest::someip {

/// Our own counter towards one receiver (a peer, or the multicast group): 1 … 65535, and over again. The reboot flag
/// is set until it wraps for the first time.
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

/// Detects that a peer has started again, from the sessions and flags of what it sends, separately for what comes by
/// multicast and by unicast, as senders count them separately.
class RebootDetector {
 public:
  /// True if this message is the first that shows a reboot. The other way's history is forgotten then: its next message
  /// would show the same reboot again. The same session within 10 ms is the network's copy, not a reboot.
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

/// A fixed number of peers. When a new one finds no place, the one not heard for longest gives way, unless it is
/// needed.
class SdPeers {
 public:
  /// `capacity` of at least one more than are ever needed at once.
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
