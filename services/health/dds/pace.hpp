// How often samples of one instance are sent. Pure: the time is an argument.
#pragma once

#include <cstdint>

namespace boresight::dds {

/// Lets one sample pass for each period. Sources with jitter keep their rate: the sample that is nearest to its turn
/// counts, which is at most half a period early.
class Pace {
 public:
  /// `period_s` 0: every sample passes.
  explicit Pace(double period_s = 0.0) : period_ns_(static_cast<std::int64_t>(period_s * 1e9)) {}

  /// Whether a sample is sent now. `at_once`: it is sent in any case, and the period begins anew.
  [[nodiscard]] bool take(std::int64_t now_ns, bool at_once = false) {
    if (!at_once && has_turn_ && now_ns < turn_ns_ - period_ns_ / 2) return false;
    const bool in_time = has_turn_ && !at_once && now_ns - turn_ns_ <= period_ns_ / 2;
    turn_ns_ = (in_time ? turn_ns_ : now_ns) + period_ns_;
    has_turn_ = true;
    return true;
  }

 private:
  std::int64_t period_ns_;
  std::int64_t turn_ns_ = 0;
  bool has_turn_ = false;
};

}  // namespace boresight::dds
