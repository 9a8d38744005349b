#include "services/alignment_estimator/core/plate/seed.hpp"

#include <cmath>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

bool seed_from_plate(const RadarConfig& radar, double yaw_rad, double yaw_std_rad, double pitch_rad,
                     double pitch_std_rad, const SeedConfig& config, RotationSeed& out) {
  const MountingPose& pose = radar.mounting_pose;
  const double cos_roll = std::cos(pose.roll_rad), sin_roll = std::sin(pose.roll_rad);
  const bool usable = std::isfinite(yaw_rad) && std::isfinite(pitch_rad) && std::isfinite(yaw_std_rad) &&
                      std::isfinite(pitch_std_rad) && yaw_std_rad >= 0.0 && pitch_std_rad >= 0.0;
  if (!usable || !(std::abs(cos_roll) >= 0.5)) return false;
  // The sensor's azimuth of the plate, −yaw, is rotated by its roll against that of an upright sensor, (10):
  // azimuth' = azimuth cos γ − elevation sin γ, where elevation' = azimuth sin γ + elevation cos γ = −pitch is known.
  const double yaw_upright = (yaw_rad - pitch_rad * sin_roll) / cos_roll;
  const double yaw_std = std::hypot(yaw_std_rad, pitch_std_rad * sin_roll) / std::abs(cos_roll);

  // Boresight's own upright axes: x along it, y to the left and level.
  const Eigen::Matrix3d upright = geometry::sensor_to_vehicle(pose.yaw_rad, pose.pitch_rad, 0.0);
  const Eigen::Matrix3d turn = upright * geometry::sensor_to_vehicle(yaw_upright, pitch_rad, 0.0) * upright.transpose();
  const double pitch_variance =
      pitch_std_rad * pitch_std_rad + config.placement_pitch_std_rad * config.placement_pitch_std_rad;
  const double yaw_variance = yaw_std * yaw_std + config.placement_yaw_std_rad * config.placement_yaw_std_rad;
  const Eigen::Vector3d variances(config.roll_std_rad * config.roll_std_rad, pitch_variance, yaw_variance);
  out.radar_id = radar.id;
  out.rotation_vehicle_rad = geometry::so3_log(turn);
  out.covariance = upright * variances.asDiagonal() * upright.transpose();
  return true;
}

bool put_seed(const RotationSeed& seed, Memory& memory) {
  if (memory.number_of_radars > kMaxRadars) return false;
  std::size_t radar = 0;
  while (radar < memory.number_of_radars && memory.radars[radar].id != seed.radar_id) ++radar;
  if (radar == kMaxRadars) return false;
  if (radar == memory.number_of_radars) ++memory.number_of_radars;
  Memory::Radar& entry = memory.radars[radar];
  entry = {};
  entry.id = seed.radar_id;
  for (std::size_t row = 0; row < 3; ++row) {
    entry.rotation_vehicle_rad[row] = seed.rotation_vehicle_rad[static_cast<Eigen::Index>(row)];
    for (std::size_t column = 0; column < 3; ++column) {
      entry.rotation_variance(row, column) =
          seed.covariance(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
    }
  }
  return true;
}

}  // namespace boresight::alignment
