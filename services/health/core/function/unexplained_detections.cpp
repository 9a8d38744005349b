#include "services/health/core/function/unexplained_detections.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/geometry/frames.hpp"

namespace boresight::health {

UnexplainedDetections::UnexplainedDetections(const RadarConfig& radar, const ExplanationConfig& config)
    : config_(config),
      to_vehicle_(geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0)),
      position_m_(radar.mounting_pose.position_m) {}

std::size_t UnexplainedDetections::collect(const RadarScan& scan, const VehicleMotion& motion,
                                           MovingOnes& moving) const {
  // In sensor axes: one rotation a scan instead of one a detection.
  const auto velocity_at = [&](double speed_mps) -> Eigen::Vector3d {
    return to_vehicle_.transpose() * geometry::sensor_velocity(1.0, speed_mps, motion.yaw_rate_radps, position_m_);
  };
  const Eigen::Vector3d velocity_mps = velocity_at(motion.speed_mps), reverse_mps = velocity_at(-motion.speed_mps);
  const bool may_reverse = !motion.is_signed && std::abs(motion.speed_mps) <= config_.fastest_reverse_mps;
  const double tolerance_mps =
      config_.stationary_tolerance_mps + config_.stationary_tolerance_ratio * velocity_mps.norm();
  const double interval_mps =
      scan.has(scan_field::kAmbiguity) ? static_cast<double>(scan.range_rate_max_mps) - scan.range_rate_min_mps : 0.0;
  std::size_t usable = 0;
  moving.count = 0;
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    if ((scan.detection_flags[i] & detection_flag::kUnusable) != 0) continue;
    ++usable;
    const Eigen::Vector3d line = geometry::direction(scan.azimuth_rad[i], scan.elevation_rad[i]);
    const auto is_stationary = [&](const Eigen::Vector3d& sensor_mps) {
      const double deviation_mps = scan.range_rate_mps[i] - geometry::stationary_range_rate(line, sensor_mps);
      const double folded_mps = interval_mps > 0.0 ? std::remainder(deviation_mps, interval_mps) : deviation_mps;
      return std::abs(folded_mps) <= tolerance_mps;
    };
    if (is_stationary(velocity_mps) || (may_reverse && is_stationary(reverse_mps))) continue;
    moving.detections[moving.count++] = {scan.range_m[i], scan.azimuth_rad[i], scan.range_rate_mps[i]};
  }
  std::sort(moving.detections.begin(), moving.detections.begin() + static_cast<std::ptrdiff_t>(moving.count),
            [](const Moving& a, const Moving& b) { return a.range_m < b.range_m; });
  return usable;
}

std::size_t UnexplainedDetections::count_new(const MovingOnes& before, const MovingOnes& now) const {
  const auto dt_s = static_cast<float>(static_cast<double>(now.time_ns - before.time_ns) * 1e-9);
  const auto distance_m = static_cast<float>(config_.neighbour_distance_m);
  const auto range_rate_mps = static_cast<float>(config_.neighbour_range_rate_mps);
  const auto end = before.detections.begin() + static_cast<std::ptrdiff_t>(before.count);
  std::size_t unexplained = 0;
  for (std::size_t i = 0; i < now.count; ++i) {
    const Moving& one = now.detections[i];
    // Where it was in the scan before, by its own range rate.
    const float range_m = one.range_m - one.range_rate_mps * dt_s;
    auto other = std::lower_bound(before.detections.begin(), end, range_m - distance_m,
                                  [](const Moving& m, float least_m) { return m.range_m < least_m; });
    bool is_seen_again = false;
    for (; other != end && other->range_m <= range_m + distance_m && !is_seen_again; ++other) {
      const float across_m = std::abs(one.azimuth_rad - other->azimuth_rad) * one.range_m;
      is_seen_again = std::abs(one.range_rate_mps - other->range_rate_mps) <= range_rate_mps && across_m <= distance_m;
    }
    if (!is_seen_again) ++unexplained;
  }
  return unexplained;
}

std::optional<ExplainedScan> UnexplainedDetections::explain(const RadarScan& scan, const VehicleMotion& motion) {
  if (!std::isfinite(motion.speed_mps)) {
    has_before_ = false;
    return std::nullopt;
  }
  const MovingOnes& before = scans_[present_];
  present_ = 1 - present_;
  MovingOnes& now = scans_[present_];
  now.time_ns = scan.header.measurement_time_ns;
  const std::size_t usable = collect(scan, motion, now);
  const double dt_s = static_cast<double>(now.time_ns - before.time_ns) * 1e-9;
  const bool follows = has_before_ && dt_s > 0.0 && dt_s <= config_.longest_interval_s;
  has_before_ = true;
  if (!follows) return std::nullopt;
  return ExplainedScan{.detections = static_cast<double>(usable),
                       .unexplained = static_cast<double>(count_new(before, now))};
}

}  // namespace boresight::health
