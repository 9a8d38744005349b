// Range rate of a stationary reflector as a function of k_v and the yaw correction, with its gradient.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace boresight::alignment {

/// The motion that one scan sees; speed as signalled.
struct ScanMotion {
  double speed_mps;
  double yaw_rate_radps;
  double sensor_x_m;
  double sensor_y_m;
};

/// Value and gradient over (k_v, yaw, δV, δω): the last two are the errors of the speed (m/s) and yaw-rate (rad/s)
/// signals of this scan.
struct RangeRatePrediction {
  double range_rate_mps;
  Eigen::Vector4d gradient;
};

/// Report A (12)–(14) with direction vectors: `direction` is the line of sight in vehicle axes by the nominal mounting
/// (unit vector); the yaw correction turns it about the vehicle's z axis.
[[nodiscard]] inline RangeRatePrediction predict_range_rate(const Eigen::Vector3d& direction, const ScanMotion& motion,
                                                            double speed_scale, double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  const double ux = c * direction.x() - s * direction.y();
  const double uy = s * direction.x() + c * direction.y();
  const double vx = speed_scale * motion.speed_mps - motion.yaw_rate_radps * motion.sensor_y_m;
  const double vy = motion.yaw_rate_radps * motion.sensor_x_m;
  RangeRatePrediction p;
  p.range_rate_mps = -(vx * ux + vy * uy);
  p.gradient << -motion.speed_mps * ux,  // (13)
      vx * uy - vy * ux,                 // (14)
      -speed_scale * ux,                 //
      motion.sensor_y_m * ux - motion.sensor_x_m * uy;
  return p;
}

}  // namespace boresight::alignment
