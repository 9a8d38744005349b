// Computes the sending time of each recorded frame.
#pragma once

#include <cstdint>

namespace boresight::replay {

/// Converts recorded stamps to sending times: real time, faster by a factor, or at once (speed 0).
class Pacing {
 public:
  explicit Pacing(double speed) : speed_(speed) {}

  /// Monotonic time of sending the frame. The first frame is due now, and so is a frame after a jump back or a pause of
  /// over ten minutes in the recording.
  [[nodiscard]] std::int64_t due_ns(std::int64_t recorded_ns, std::int64_t now_ns) {
    constexpr std::int64_t kPause_ns = 600'000'000'000;
    if (!anchored_ || recorded_ns < last_ns_ - 1'000'000'000 || recorded_ns > last_ns_ + kPause_ns) {
      anchored_ = true;
      anchor_recorded_ns_ = recorded_ns;
      anchor_ns_ = now_ns;
    }
    last_ns_ = recorded_ns;
    if (speed_ <= 0.0) return now_ns;
    return anchor_ns_ + static_cast<std::int64_t>(static_cast<double>(recorded_ns - anchor_recorded_ns_) / speed_);
  }

 private:
  double speed_;
  bool anchored_ = false;
  std::int64_t anchor_recorded_ns_ = 0;
  std::int64_t anchor_ns_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace boresight::replay
