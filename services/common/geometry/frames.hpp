// Rotations between the sensor's and the vehicle's frame, and the range rate of a stationary reflector. The only code
// with the signs of docs/algorithms/frames.md (F1)–(F8).
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::geometry {

/// R(sensor→vehicle) = R_z(yaw)·R_y(−pitch)·R_x(roll); yaw + left, pitch + up, roll about boresight. Radians.
[[nodiscard]] inline Eigen::Matrix3d sensor_to_vehicle(double yaw_rad, double pitch_rad, double roll_rad) {
  const double cy = std::cos(yaw_rad), sy = std::sin(yaw_rad);
  const double cp = std::cos(pitch_rad), sp = std::sin(pitch_rad);
  const double cr = std::cos(roll_rad), sr = std::sin(roll_rad);
  Eigen::Matrix3d r;
  r << cy * cp, -cy * sp * sr - sy * cr, -cy * sp * cr + sy * sr,  //
      sy * cp, -sy * sp * sr + cy * cr, -sy * sp * cr - cy * sr,   //
      sp, cp * sr, cp * cr;
  return r;
}

/// The nominal mounting with a correction added angle by angle: α_b+α_m, β_b+β_m, γ_b+γ_m (docs/algorithms/frames.md
/// (F2)).
[[nodiscard]] inline Eigen::Matrix3d sensor_to_vehicle(const MountingPose& nominal, double alignment_yaw_rad,
                                                       double alignment_pitch_rad, double alignment_roll_rad) {
  return sensor_to_vehicle(nominal.yaw_rad + alignment_yaw_rad, nominal.pitch_rad + alignment_pitch_rad,
                           nominal.roll_rad + alignment_roll_rad);
}

/// Unit vector of a line of sight, u = (cos β cos α, cos β sin α, sin β).
[[nodiscard]] inline Eigen::Vector3d direction(double azimuth_rad, double elevation_rad) {
  const double ce = std::cos(elevation_rad);
  return {ce * std::cos(azimuth_rad), ce * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

/// Velocity over ground of a sensor at `position_m` (vehicle frame), in vehicle axes:
/// (k_v·V − ω·y_s, V_y + ω·x_s, 0); V and V_y at the rear axle in m/s, ω in rad/s.
[[nodiscard]] inline Eigen::Vector3d sensor_velocity(double speed_scale, double speed_mps, double yaw_rate_radps,
                                                     const std::array<double, 3>& position_m,
                                                     double lateral_speed_mps = 0.0) {
  return {speed_scale * speed_mps - yaw_rate_radps * position_m[1], lateral_speed_mps + yaw_rate_radps * position_m[0],
          0.0};
}

/// Range rate of a stationary reflector: ṙ = −(R u)·v_s. Receding is positive.
[[nodiscard]] inline double stationary_range_rate(const Eigen::Vector3d& direction_vehicle,
                                                  const Eigen::Vector3d& sensor_velocity_mps) {
  return -direction_vehicle.dot(sensor_velocity_mps);
}

/// Angle wrapped into (−π, π].
[[nodiscard]] inline double wrap_angle(double angle_rad) {
  // remainder() rounds a tie to even, which is −π for some odd multiples of π.
  const double wrapped = std::remainder(angle_rad, 2.0 * M_PI);
  return wrapped <= -M_PI ? M_PI : wrapped;
}

}  // namespace boresight::geometry
