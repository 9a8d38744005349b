#include "services/detection_corrector/core/ego_velocity.hpp"

#include <cmath>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::corrector {

namespace {

double known_or(double std, double fallback) {
  return std::isfinite(std) && std > 0.0 ? std : fallback;
}

}  // namespace

EgoVelocity ego_velocity(const EgoSample& sample, const EgoConfig& ego, const MountingPose& pose,
                         const Mounting& mounting) {
  EgoVelocity out;
  const double scale = mounting.speed_scale, slip = mounting.slip_coefficient_radps2pm;
  const double seen = mounting.range_rate_scale, gain = mounting.yaw_rate_gain;
  const double speed = scale * sample.speed_mps;
  const double unbiased = sample.yaw_rate_radps - mounting.yaw_rate_bias_radps;
  const double yaw_rate = gain * unbiased;
  out.speed_mps = speed;
  out.yaw_rate_radps = yaw_rate;
  // In a turn the rear axle slides outwards: V_y = −c·V·(V·ω).
  out.sensor_mps = geometry::sensor_velocity(1.0, speed, yaw_rate, pose.position_m, -slip * speed * speed * yaw_rate);
  out.seen_mps = seen * out.sensor_mps;

  // Derivatives of v_s; those of g are `seen` times as large.
  const Eigen::Vector3d by_speed(1.0, -2.0 * slip * speed * yaw_rate, 0.0);
  const Eigen::Vector3d by_yaw_rate(-pose.position_m[1], pose.position_m[0] - slip * speed * speed, 0.0);
  const Eigen::Vector3d by_slip(0.0, -speed * speed * yaw_rate, 0.0);
  const double speed_std = scale * known_or(sample.speed_std_mps, ego.speed_std_mps);
  const double yaw_rate_std = known_or(sample.yaw_rate_std_radps, ego.yaw_rate_std_radps);
  const double yaw_rate_variance = gain * gain * (yaw_rate_std * yaw_rate_std + mounting.yaw_rate_bias_variance) +
                                   unbiased * unbiased * mounting.yaw_rate_gain_variance;
  // e with (1 + e)·k_v as it is known: of g, not of v_s.
  const Eigen::Vector3d by_range_rate_scale = out.sensor_mps - speed * by_speed;
  Eigen::Matrix<double, 3, 4> by_mounting;
  by_mounting.col(0) = sample.speed_mps * by_speed;
  by_mounting.rightCols<3>() = geometry::cross_matrix(out.seen_mps);
  out.covariance = by_mounting * mounting.covariance * by_mounting.transpose() +
                   mounting.range_rate_scale_variance * by_range_rate_scale * by_range_rate_scale.transpose() +
                   seen * seen *
                       (speed_std * speed_std * by_speed * by_speed.transpose() +
                        yaw_rate_variance * by_yaw_rate * by_yaw_rate.transpose() +
                        mounting.slip_variance * by_slip * by_slip.transpose());
  return out;
}

}  // namespace boresight::corrector
