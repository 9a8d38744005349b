#include "services/detection_corrector/core/mounting.hpp"

#include <cmath>

#include "services/common/geometry/frames.hpp"

namespace boresight::corrector {

namespace {

bool is_sure(const AlignmentEstimate& estimate, std::uint32_t axis, std::size_t index, double max_std) {
  const double variance = estimate.covariance[index * kNumberOfAlignmentParameters + index];
  return estimate.is_observable(axis) && variance >= 0.0 && variance <= max_std * max_std;
}

}  // namespace

Mounting mounting_of(const RadarConfig& radar, const AlignmentEstimate* estimate, const Config& config) {
  Mounting mounting;
  double yaw = 0.0, pitch = 0.0, roll = 0.0;
  if (estimate != nullptr) {
    const double max_std = config.max_angle_std_to_apply_rad;
    const auto take = [&](std::uint32_t axis, std::size_t index, double limit, float value, double& target) {
      if (!is_sure(*estimate, axis, index, limit) || !std::isfinite(value)) return;
      target = value;
      mounting.alignment_sequence = estimate->header.sequence;
    };
    take(alignment_axis::kSpeedScale, 0, config.max_speed_scale_std_to_apply, estimate->speed_scale,
         mounting.speed_scale);
    take(alignment_axis::kYaw, 1, max_std, estimate->alignment_yaw_rad, yaw);
    take(alignment_axis::kPitch, 2, max_std, estimate->alignment_pitch_rad, pitch);
    take(alignment_axis::kRoll, 3, max_std, estimate->alignment_roll_rad, roll);
  }
  mounting.sensor_to_vehicle = geometry::sensor_to_vehicle(radar.mounting_pose, yaw, pitch, roll);
  return mounting;
}

}  // namespace boresight::corrector
