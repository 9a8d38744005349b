// How much of what goes on all the time is due with a scan: by the time that went by, so that more radars, whose scans
// come the more often, do not make it more often than is needed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace boresight::ghosts {

class Pace {
 public:
  /// So many at once, and as many again after `period_s`. Scans that come together share what is due, of up to four.
  Pace(std::size_t at_once, double period_s)
      : most_at_once_(static_cast<double>(at_once)), per_s_(most_at_once_ / period_s), due_(most_at_once_) {}
  /// Time went by; not a number counts as none.
  void advance(double elapsed_s) {
    constexpr double kKept = 4.0;
    due_ = std::min(kKept * most_at_once_, due_ + per_s_ * std::max(0.0, elapsed_s));
  }
  /// How many of so many are done now.
  [[nodiscard]] std::size_t take(std::size_t wanted) {
    // Rounded: periods are not kept to the nanosecond.
    const double most = std::min(most_at_once_, std::round(due_));
    const std::size_t taken = std::min(wanted, static_cast<std::size_t>(most));
    due_ -= static_cast<double>(taken);
    return taken;
  }

 private:
  double most_at_once_, per_s_, due_;
};

}  // namespace boresight::ghosts
