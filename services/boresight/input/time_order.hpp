// Checks that the times of a table's rows increase, within tolerances.
#pragma once

#include <algorithm>
#include <cmath>

namespace boresight::input {

/// Times may go back by a second (radars are not synchronised) and forward by an hour (the vehicle was parked). A
/// larger step forward is an error of a single line, unless the next line confirms it: then the drive continues from
/// there. A larger step back is never accepted, because estimates cannot be undone.
class TimeOrder {
 public:
  static constexpr double kBack_s = 1.0, kForward_s = 3600.0;
  /// Allowed times, so that differences fit into nanoseconds of 64 bits.
  static constexpr double kMin_s = -4e9, kMax_s = 4e9;

  [[nodiscard]] bool accept(double time_s) {
    const bool is_forward = !(time_s > newest_s_ + kForward_s);
    const bool is_confirmed = std::abs(time_s - doubtful_s_) <= kBack_s && time_s > newest_s_;
    doubtful_s_ = time_s;
    if (std::isnan(newest_s_) || ((is_forward || is_confirmed) && time_s >= newest_s_ - kBack_s)) {
      newest_s_ = std::isnan(newest_s_) ? time_s : std::max(newest_s_, time_s);
      return true;
    }
    return false;
  }
  [[nodiscard]] double newest_s() const { return newest_s_; }

 private:
  double newest_s_ = NAN;
  double doubtful_s_ = NAN;  // time of the previous line
};

}  // namespace boresight::input
