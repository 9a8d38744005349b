#include "services/alignment_estimator/core/filter/motion_model.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

/// A lateral velocity counts fully up to a relative variance of 1/kLateralVelocityDoubt, and not at all above twice
/// that.
constexpr double kLateralVelocityDoubt = 8.0;

}  // namespace

SensorVelocity sensor_velocity(const JointState& state, const Eigen::Vector4d& nuisances, std::size_t radar,
                               const std::array<double, 3>& position_m, const ScanMotion3d& motion,
                               double pitch_share) {
  const double x = position_m[0], y = position_m[1];
  const double signalled = motion.speed_mps + nuisances(0);
  const double speed = state.linearised_speed_scale * signalled;
  const double yaw_rate = motion.yaw_rate_radps + nuisances(1) - state.yaw_rate_bias_radps;
  const double slip = state.slip_radps2pm;
  const double pitch = nuisances(2) + state.pitch_per_acceleration_radps2pm * motion.acceleration_mps2;
  const auto velocity = [&](double s) {
    return Eigen::Vector3d(s - yaw_rate * y, yaw_rate * x - slip * s * s * yaw_rate + s * nuisances(3), s * pitch);
  };
  const Eigen::Vector3d v = velocity(speed);
  const Eigen::Vector3d by_speed(1.0, -2.0 * slip * speed * yaw_rate + nuisances(3), pitch);
  const Eigen::Vector3d by_yaw_rate(-y, x - slip * speed * speed, 0.0);
  const double lowering = state.lowering[radar], scale = std::exp(-lowering * state.elevation_excess[radar]);
  const Eigen::Matrix3d to_sensor = scale * state.linearised[radar].transpose();
  SensorVelocity out;
  // The difference to that rotation enters linearly. Its second order would look like a change of speed although it
  // comes from the prior alone. Known axes are never far from it.
  const Eigen::Vector3d off = geometry::so3_log(state.sensor_to_vehicle[radar] * state.linearised[radar].transpose());
  out.g = to_sensor * (velocity(state.speed_scale * signalled) + v.cross(off));
  Eigen::Matrix<double, 3, column::kTouched> by;
  by.col(column::kSpeedScale) = signalled * by_speed;
  by.col(column::kYawRateBias) = -by_yaw_rate;
  by.col(column::kSlip) << 0.0, -speed * speed * yaw_rate, 0.0;
  by.col(column::kPitchPerAcceleration) << 0.0, 0.0, speed * motion.acceleration_mps2;
  by.col(column::kSpeed) = state.linearised_speed_scale * by_speed;
  by.col(column::kYawRate) = by_yaw_rate;
  by.col(column::kBodyPitch) << 0.0, 0.0, speed;
  by.col(column::kSideSlip) << 0.0, speed, 0.0;
  // (Exp(d)·R)ᵀ·v = Rᵀ·(v − d × v) = Rᵀ·(v + v × d).
  by.middleCols<3>(column::kShared) = geometry::cross_matrix(v);
  // Roll acts only through the small lateral and vertical velocities. If their errors are as large as they are, the
  // noise would look like the motion that makes roll observable.
  const double lateral = (x - slip * speed * speed) * (motion.yaw_rate_radps - state.yaw_rate_bias_radps);
  const double by_slip = speed * speed * yaw_rate, by_rate = x - slip * speed * speed;
  const double variance = by_slip * by_slip * state.covariance(column::kSlip, column::kSlip) +
                          by_rate * by_rate *
                              (state.covariance(column::kYawRateBias, column::kYawRateBias) +
                               state.covariance(column::kYawRate, column::kYawRate));
  const double lateral_share =
      std::clamp(2.0 - kLateralVelocityDoubt * variance / (lateral * lateral + 1e-12), 0.0, 1.0);
  const double by_acceleration = state.pitch_per_acceleration_radps2pm;
  const double stds = std::abs(by_acceleration) /
                      std::sqrt(state.covariance(column::kPitchPerAcceleration, column::kPitchPerAcceleration) + 1e-12);
  const double vertical = speed * (pitch_share * nuisances(2) +
                                   std::clamp(stds - 2.0, 0.0, 1.0) * by_acceleration * motion.acceleration_mps2);
  by.col(column::kShared) << 0.0, vertical, -lateral_share * lateral;
  by.col(column::kShared + column::kElevations) = -lowering * v;
  by.col(column::kShared + column::kAngleNoise).setZero();
  out.gradient.noalias() = (to_sensor * by).transpose();
  return out;
}

void SensorVelocity::seen(const Support& support, double log_angle_noise) {
  const Eigen::Vector3d by_noise = support.by_angle_noise * g;
  gradient.row(column::kShared + column::kAngleNoise) = by_noise.transpose();
  g += log_angle_noise * by_noise;
  if (support.directions < 3) gradient.middleRows<2>(column::kShared).setZero();
}

}  // namespace boresight::alignment
