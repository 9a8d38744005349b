#include "services/common/estimation/ego_history.hpp"

#include <cmath>
#include <cstdlib>

namespace boresight {

void EgoHistory::add(const EgoMotion& motion) {
  if (!motion.has(ego_field::kSpeed | ego_field::kYawRate)) return;
  if (!std::isfinite(motion.speed_mps) || !std::isfinite(motion.yaw_rate_radps)) return;
  const std::int64_t time_ns = motion.header.measurement_time_ns;
  if (size_ > 0 && time_ns <= newest(0).time_ns) {
    constexpr std::int64_t kRestart_ns = 1'000'000'000;
    if (newest(0).time_ns - time_ns < kRestart_ns) return;
    size_ = 0;
  }
  ring_[next_] = {time_ns, motion.speed_mps, motion.speed_std_mps, motion.yaw_rate_radps, motion.yaw_rate_std_radps};
  next_ = (next_ + 1) % ring_.size();
  if (size_ < ring_.size()) ++size_;
}

EgoSample EgoHistory::at(std::int64_t time_ns) const {
  if (size_ == 0) return {};
  const auto held = [&](const Entry& e) {
    return EgoSample{true,
                     std::abs(time_ns - e.time_ns) > max_age_ns_,
                     e.speed_mps,
                     e.speed_std_mps,
                     e.yaw_rate_radps,
                     e.yaw_rate_std_radps};
  };
  if (time_ns >= newest(0).time_ns) return held(newest(0));
  for (std::size_t back = 1; back < size_; ++back) {
    const Entry& before = newest(back);
    if (before.time_ns > time_ns) continue;
    const Entry& after = newest(back - 1);
    // No interpolation across a gap in the signal.
    if (after.time_ns - before.time_ns > max_age_ns_) {
      return held(time_ns - before.time_ns < after.time_ns - time_ns ? before : after);
    }
    const double w =
        static_cast<double>(time_ns - before.time_ns) / static_cast<double>(after.time_ns - before.time_ns);
    return {true,
            false,
            before.speed_mps + w * (after.speed_mps - before.speed_mps),
            after.speed_std_mps,
            before.yaw_rate_radps + w * (after.yaw_rate_radps - before.yaw_rate_radps),
            after.yaw_rate_std_radps};
  }
  return held(newest(size_ - 1));
}

}  // namespace boresight
