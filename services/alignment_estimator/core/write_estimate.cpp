#include "services/alignment_estimator/core/write_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

void write_covariance(const Eigen::Matrix4d& covariance, std::array<float, 16>& out) {
  Eigen::Map<Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(out.data()) = covariance.cast<float>();
}

/// A sensor's axis is a mixture of the vehicle's axes. What it takes from one that is not observable is as uncertain as
/// before any data: a roll that is known by half would else pass as the pitch of a radar that looks aside.
Eigen::Matrix4d without_unobservable(const RadarEstimate& estimate, double prior_angle_std_rad) {
  const std::array<std::uint32_t, 3> bits{alignment_axis::kVehicleRoll, alignment_axis::kVehiclePitch,
                                          alignment_axis::kVehicleYaw};
  Eigen::Matrix4d covariance = estimate.covariance;
  for (int axis = 0; axis < 3; ++axis) {
    double& variance = covariance(axis + 1, axis + 1);
    if ((estimate.observable & bits[static_cast<std::size_t>(axis)]) != 0) continue;
    variance = std::max(variance, prior_angle_std_rad * prior_angle_std_rad);
  }
  return covariance;
}

}  // namespace

Eigen::Vector3d vehicle_angles(const RadarConfig& radar, const Eigen::Matrix3d& sensor_to_vehicle) {
  const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
  return geometry::fixed_axes_angles(sensor_to_vehicle * nominal.transpose());
}

VehicleForm vehicle_form(const RadarConfig& radar, const RadarEstimate& estimate) {
  VehicleForm form;
  form.values << estimate.speed_scale, vehicle_angles(radar, estimate.sensor_to_vehicle);
  Eigen::Matrix4d gradient = Eigen::Matrix4d::Identity();
  gradient.bottomRightCorner<3, 3>() = geometry::fixed_axes_gradient(form.values(2), form.values(3));
  form.covariance = gradient * estimate.covariance * gradient.transpose();
  return form;
}

void write_estimate(const RadarConfig& radar, const RadarEstimate& estimate, double prior_angle_std_rad,
                    AlignmentEstimate& out) {
  out.state = estimate.state;
  out.reason = estimate.reason;
  out.finding = AlignmentFinding::kNone;
  out.finding_value = 0.0F;
  out.finding_radar = 0;
  out.reserved = 0;
  const VehicleForm vehicle = vehicle_form(radar, estimate);
  out.speed_scale = static_cast<float>(estimate.speed_scale);
  out.vehicle_yaw_rad = static_cast<float>(vehicle.values(1));
  out.vehicle_pitch_rad = static_cast<float>(vehicle.values(2));
  out.vehicle_roll_rad = static_cast<float>(vehicle.values(3));
  write_covariance(vehicle.covariance, out.vehicle_covariance);

  const Eigen::Vector3d angles = geometry::euler_angles(estimate.sensor_to_vehicle);
  const MountingPose& nominal = radar.mounting_pose;
  out.alignment_yaw_rad = static_cast<float>(geometry::wrap_angle(angles(0) - nominal.yaw_rad));
  out.alignment_pitch_rad = static_cast<float>(angles(1) - nominal.pitch_rad);
  out.alignment_roll_rad = static_cast<float>(geometry::wrap_angle(angles(2) - nominal.roll_rad));
  Eigen::Matrix4d to_angles = Eigen::Matrix4d::Identity();
  to_angles.bottomRightCorner<3, 3>() = geometry::euler_gradient(angles(0), angles(1));
  const Eigen::Matrix4d covariance = to_angles * estimate.covariance * to_angles.transpose();
  write_covariance(covariance, out.covariance);

  out.observable = estimate.observable;
  const double limit = 0.25 * prior_angle_std_rad * prior_angle_std_rad;
  const Eigen::Matrix4d doubted =
      to_angles * without_unobservable(estimate, prior_angle_std_rad) * to_angles.transpose();
  if (doubted(1, 1) < limit) out.observable |= alignment_axis::kYaw;
  if (doubted(2, 2) < limit) out.observable |= alignment_axis::kPitch;
  if (doubted(3, 3) < limit) out.observable |= alignment_axis::kRoll;

  out.yaw_rate_bias_radps = static_cast<float>(estimate.yaw_rate_bias_radps);
  out.yaw_rate_bias_std_radps = static_cast<float>(estimate.yaw_rate_bias_std_radps);
  out.slip_coefficient_radps2pm = static_cast<float>(estimate.slip_coefficient_radps2pm);
  out.slip_coefficient_std_radps2pm = static_cast<float>(estimate.slip_coefficient_std_radps2pm);
  out.angle_noise_scale = static_cast<float>(estimate.angle_noise_scale);
  out.step_change = estimate.step_change;
  out.load_change = estimate.load_change;
  out.speed_change = estimate.speed_change;
  out.drift = estimate.drift;
  out.nuisance = estimate.nuisance;
}

}  // namespace boresight::alignment
