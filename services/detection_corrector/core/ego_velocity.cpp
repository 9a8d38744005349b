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
  const double speed = scale * sample.speed_mps;
  const double yaw_rate = sample.yaw_rate_radps - mounting.yaw_rate_bias_radps;
  out.speed_mps = speed;
  out.yaw_rate_radps = yaw_rate;
  // In a turn the rear axle slides outwards: V_y = −c·V·(V·ω).
  out.sensor_mps = geometry::sensor_velocity(1.0, speed, yaw_rate, pose.position_m, -slip * speed * speed * yaw_rate);

  const Eigen::Vector3d by_speed(1.0, -2.0 * slip * speed * yaw_rate, 0.0);
  const Eigen::Vector3d by_yaw_rate(-pose.position_m[1], pose.position_m[0] - slip * speed * speed, 0.0);
  const Eigen::Vector3d by_slip(0.0, -speed * speed * yaw_rate, 0.0);
  const double speed_std = scale * known_or(sample.speed_std_mps, ego.speed_std_mps);
  const double yaw_rate_std = known_or(sample.yaw_rate_std_radps, ego.yaw_rate_std_radps);
  Eigen::Matrix<double, 3, 4> by_mounting;
  by_mounting.col(0) = sample.speed_mps * by_speed;
  by_mounting.rightCols<3>() = geometry::cross_matrix(out.sensor_mps);
  out.covariance =
      by_mounting * mounting.covariance * by_mounting.transpose() +
      speed_std * speed_std * by_speed * by_speed.transpose() +
      (yaw_rate_std * yaw_rate_std + mounting.yaw_rate_bias_variance) * by_yaw_rate * by_yaw_rate.transpose() +
      mounting.slip_variance * by_slip * by_slip.transpose();
  return out;
}

}  // namespace boresight::corrector
