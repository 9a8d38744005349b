#include "services/alignment_estimator/core/filter/ego_trend.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/small_maths.hpp"

namespace boresight::alignment {

namespace {

constexpr double kWindow_s = 0.4;
constexpr double kMaxHeld_s = 0.1;
constexpr double kMaxAcceleration_mps2 = 15.0, kMaxYawAcceleration_radps2 = 5.0;

}  // namespace

ScanMotion3d EgoTrend::at(std::int64_t time_ns, const EgoSample& ego) {
  double held_s = 0.0;
  const double since_s = size_ > 0 ? seconds(time_ns - newest(0).time_ns) : 0.0;
  const bool repeated =
      size_ > 0 && ego.speed_mps == newest(0).speed_mps && ego.yaw_rate_radps == newest(0).yaw_rate_radps;
  if (size_ > 0 && (since_s < -0.5 || since_s > kWindow_s)) {
    size_ = 0;
    acceleration_mps2_ = yaw_acceleration_radps2_ = 0.0;
  }
  if (size_ > 0 && repeated && since_s >= 0.0) {
    held_s = std::min(since_s, kMaxHeld_s);
  } else if (size_ == 0 || since_s > 0.0) {
    ring_[next_] = {time_ns, ego.speed_mps, ego.yaw_rate_radps};
    next_ = (next_ + 1) % ring_.size();
    size_ = std::min(size_ + 1, ring_.size());
    fit();
  }
  return {ego.speed_mps + acceleration_mps2_ * held_s, ego.yaw_rate_radps + yaw_acceleration_radps2_ * held_s,
          acceleration_mps2_, yaw_acceleration_radps2_};
}

void EgoTrend::fit() {
  double n = 0.0, t1 = 0.0, t2 = 0.0, v1 = 0.0, vt = 0.0, w1 = 0.0, wt = 0.0;
  const Entry& last = newest(0);
  for (std::size_t i = 0; i < size_; ++i) {
    const Entry& e = newest(i);
    const double t = seconds(e.time_ns - last.time_ns);
    if (t < -kWindow_s) break;
    n += 1.0;
    t1 += t;
    t2 += t * t;
    v1 += e.speed_mps;
    vt += t * e.speed_mps;
    w1 += e.yaw_rate_radps;
    wt += t * e.yaw_rate_radps;
  }
  const double spread = n * t2 - t1 * t1;
  // The slope of fewer than four values is dominated by their noise.
  if (n < 4.0 || !(spread > 1e-6)) {
    acceleration_mps2_ = yaw_acceleration_radps2_ = 0.0;
    return;
  }
  acceleration_mps2_ = std::clamp((n * vt - t1 * v1) / spread, -kMaxAcceleration_mps2, kMaxAcceleration_mps2);
  yaw_acceleration_radps2_ =
      std::clamp((n * wt - t1 * w1) / spread, -kMaxYawAcceleration_radps2, kMaxYawAcceleration_radps2);
}

}  // namespace boresight::alignment
