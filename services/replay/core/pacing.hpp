// When each frame of a recording is due.
#pragma once

#include <cstdint>

namespace boresight::replay {

/// Maps recorded stamps to due times: real time, faster by a factor, or at once (speed 0).
class Pacing {
 public:
  explicit Pacing(double speed) : speed_(speed) {}

  /// Monotonic time at which the frame is due; the first frame is due now, and again where the recording jumps back or
  /// pauses for over ten minutes.
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
