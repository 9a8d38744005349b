// When live input may be told that time has passed.
#pragma once

#include <cstdint>
#include <utility>

namespace boresight::ingest {

/// After a pause of the process the clock is ahead of the frames that waited, and of those on one link more than of
/// those on another. What they complete must not be given up before they have been read.
class Backlog {
 public:
  /// A frame was taken so long after its reception.
  void frame_taken(std::int64_t age_ns) {
    constexpr std::int64_t kLate_ns = 10'000'000;
    behind_ = behind_ || age_ns > kLate_ns;
  }
  /// To be asked every 5 ms or so: whether what had arrived has been read, so that time may go on. After 100 times no
  /// the answer is yes in any case, as the stamps of a link may be late always.
  [[nodiscard]] bool is_read(std::int64_t now_ns) {
    constexpr std::int64_t kPaused_ns = 25'000'000;
    constexpr int kMostHeldBack = 100;
    // What came during a pause may not even have been looked at.
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
