#include "services/ghost_filter/core/published/stationary_map.hpp"

#include "services/common/geometry/ego_step.hpp"

namespace boresight::ghosts::published {

StationaryMap::StationaryMap() {
  points_.reserve(kCapacity);
  times_ns_.reserve(kCapacity);
}

void StationaryMap::advance(std::int64_t time_ns, double speed_mps, double yaw_rate_radps, double memory_s) {
  const std::int64_t elapsed_ns = time_ns - now_ns_;
  const auto memory_ns = static_cast<std::int64_t>(memory_s * 1e9);
  if (elapsed_ns < -1'000'000'000 || elapsed_ns > memory_ns) {
    points_.clear();
    times_ns_.clear();
  }
  now_ns_ = time_ns;
  const geometry::EgoStep step = geometry::ego_step(speed_mps, yaw_rate_radps, static_cast<double>(elapsed_ns) * 1e-9);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (times_ns_[i] < time_ns - memory_ns) continue;
    points_[kept] = step.move_point(points_[i]);
    times_ns_[kept] = times_ns_[i];
    ++kept;
  }
  points_.resize(kept);
  times_ns_.resize(kept);
}

void StationaryMap::add(const Eigen::Vector2d& position_m) {
  if (points_.size() == kCapacity) {
    // Dropping half at once keeps the cost of a full map constant on average.
    points_.erase(points_.begin(), points_.begin() + kCapacity / 2);
    times_ns_.erase(times_ns_.begin(), times_ns_.begin() + kCapacity / 2);
  }
  points_.push_back(position_m);
  times_ns_.push_back(now_ns_);
}

}  // namespace boresight::ghosts::published
