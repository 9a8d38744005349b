#include "services/alignment_estimator/core/windows/scan_model.hpp"

#include <cmath>

namespace boresight::alignment::windows {

ScanModel model_scan(const Point& point, const std::array<double, 3>& position_m, const Motion& motion) {
  const double x = position_m[0] + point.position_error_m.x(), y = position_m[1] + point.position_error_m.y();
  const double scale = 1.0 + point.rate_scale, gain = 1.0 + point.yaw_rate_gain;
  const double signalled = motion.speed_mps, speed = point.speed_scale * signalled;
  const double unbiased = motion.yaw_rate_radps - point.yaw_rate_bias_radps, yaw_rate = gain * unbiased;
  const double slip = point.slip_radps2pm, acceleration = motion.acceleration_mps2;
  const Eigen::Vector3d v(speed - yaw_rate * y, yaw_rate * x - slip * speed * speed * yaw_rate,
                          point.pitch_per_acceleration_radps2pm * acceleration * speed);
  const Eigen::Vector3d by_speed(1.0, -2.0 * slip * speed * yaw_rate,
                                 point.pitch_per_acceleration_radps2pm * acceleration);
  const Eigen::Vector3d by_yaw_rate(-y, x - slip * speed * speed, 0.0);
  const Eigen::Matrix3d to_sensor = scale * point.sensor_to_vehicle.transpose();
  Eigen::Matrix<double, 3, local::kCurve> by;
  by.col(local::kSpeedScale) = signalled * by_speed;
  by.col(local::kRateScale) = v / scale;
  // (Exp(d)·R)ᵀ·v = Rᵀ·(v + v × d).
  by.middleCols<3>(local::kRotation) = geometry::cross_matrix(v);
  // The product of the roll and of the body's pitch is not used: side slip that goes with braking would pose as roll.
  by(1, local::kRotation) = 0.0;
  by.col(local::kYawRateBias) = -gain * by_yaw_rate;
  // The noise of a small yaw rate would pose as a yaw rate, and draw the gain down: errors in variables.
  constexpr double kLeastStds = 5.0;
  const bool turns = std::abs(unbiased) > kLeastStds * motion.yaw_rate_std_radps;
  by.col(local::kYawRateGain) = (turns ? unbiased : 0.0) * by_yaw_rate;
  by.col(local::kSlip) << 0.0, (turns ? -speed * speed * yaw_rate : 0.0), 0.0;
  by.col(local::kStamp) = point.speed_scale * motion.clear_acceleration_mps2 * by_speed +
                          gain * motion.clear_yaw_acceleration_radps2 * by_yaw_rate;
  by.col(local::kPosition) << 0.0, yaw_rate, 0.0;
  by.col(local::kPosition + 1) << -yaw_rate, 0.0, 0.0;
  by.col(local::kPitchPerAcceleration) << 0.0, 0.0, acceleration * speed;
  Eigen::Matrix<double, 3, kMotionErrors> errors;
  errors.col(0) = point.speed_scale * by_speed;
  errors.col(1) = gain * by_yaw_rate;
  errors.col(2) << 0.0, 0.0, speed;
  errors.col(3) << 0.0, speed, 0.0;
  ScanModel model;
  model.g = to_sensor * v;
  model.by_parameter.noalias() = (to_sensor * by).transpose();
  model.by_motion.noalias() = (to_sensor * errors).transpose();
  return model;
}

}  // namespace boresight::alignment::windows
