// Which of several waiting scans a service handles, and in which order: the newest of each radar, the oldest
// measurement first.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "interfaces/messages/header.hpp"

namespace boresight::runtime {

/// The newest waiting message of each source. Keeps addresses only, so a message must live until this class returns it.
///
/// The newest message of a source is the one that arrived last, as a writer publishes the scans of a radar in their
/// order. The measurement time does not decide: after a clock went back, a new scan has an early time.
class NewestPerSource {
 public:
  /// Messages that wait at most.
  static constexpr std::size_t kCapacity = kMaxRadars;

  struct Next {
    const MessageHeader* message = nullptr;  ///< nullptr: none waits
    std::uint64_t superseded = 0;            ///< messages of this source that were dropped since its previous one
  };

  /// `message` arrived last. Returns the waiting message that it supersedes, or nullptr.
  const MessageHeader* add(const MessageHeader& message) {
    Source& source = sources_[message.source_id % kCapacity];
    if (message.measurement_time_ns < source.last_time_ns) ++clock_epoch_;
    source.last_time_ns = message.measurement_time_ns;
    source.clock_epoch = clock_epoch_;
    const MessageHeader* const superseded = std::exchange(source.waiting, &message);
    if (superseded != nullptr) ++source.superseded;
    return superseded;
  }

  [[nodiscard]] bool is_any_waiting() const {
    return std::any_of(sources_.begin(), sources_.end(), [](const Source& s) { return s.waiting != nullptr; });
  }

  /// The waiting message with the earliest measurement time, which then waits no more. Messages that arrived before
  /// the clock of any source went back come first.
  Next take() {
    Source* first = nullptr;
    for (Source& source : sources_) {
      if (source.waiting != nullptr && (first == nullptr || is_before(source, *first))) first = &source;
    }
    if (first == nullptr) return {};
    return {std::exchange(first->waiting, nullptr), std::exchange(first->superseded, 0)};
  }

 private:
  struct Source {
    const MessageHeader* waiting = nullptr;
    std::uint64_t superseded = 0;
    std::uint64_t clock_epoch = 0;
    std::int64_t last_time_ns = std::numeric_limits<std::int64_t>::min();
  };

  [[nodiscard]] static bool is_before(const Source& a, const Source& b) {
    return std::pair(a.clock_epoch, a.last_time_ns) < std::pair(b.clock_epoch, b.last_time_ns);
  }

  std::array<Source, kCapacity> sources_{};
  std::uint64_t clock_epoch_ = 0;  // of the latest arrival; grows when the clock of a source goes back
};

}  // namespace boresight::runtime
