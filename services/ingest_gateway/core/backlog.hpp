// Decides when the clock of live input may advance.
#pragma once

#include <cstdint>
#include <utility>

namespace boresight::ingest {

/// After a pause of the process the clock is ahead of the waiting frames, by a different time on each link. Cycles and
/// messages that these frames complete must not be dropped before the frames have been read.
class Backlog {
 public:
  /// A frame was read with this delay after its reception.
  void frame_taken(std::int64_t age_ns) {
    constexpr std::int64_t kLate_ns = 10'000'000;
    behind_ = behind_ || age_ns > kLate_ns;
  }
  /// Call about every 5 ms: true if all waiting frames have been read, so that time may advance. After 100 calls the
  /// result is true in any case, as the stamps of a link may always be late.
  [[nodiscard]] bool is_read(std::int64_t now_ns) {
    constexpr std::int64_t kPaused_ns = 25'000'000;
    constexpr int kMostHeldBack = 100;
    // Frames that arrived during a pause may not have been read yet.
    const bool paused = now_ns - std::exchange(asked_ns_, now_ns) > kPaused_ns;
    const bool behind = std::exchange(behind_, false);
    const bool hold_back = (paused || behind) && held_back_ < kMostHeldBack;
    held_back_ = hold_back ? held_back_ + 1 : 0;
    return !hold_back;
  }

 private:
  bool behind_ = false;
  int held_back_ = 0;
  std::int64_t asked_ns_ = 0;
};

}  // namespace boresight::ingest
