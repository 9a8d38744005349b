// Estimate of a method → message: the same rotation about the vehicle's and about the sensor's axes.
#pragma once

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// (k_v, yaw, pitch, roll) about the vehicle's axes, with the signs of the message, and their covariance.
struct VehicleForm {
  Eigen::Vector4d values;
  Eigen::Matrix4d covariance;
};
[[nodiscard]] VehicleForm vehicle_form(const RadarConfig& radar, const RadarEstimate& estimate);

/// Yaw, pitch and roll of the rotation from the nominal mounting to this one.
[[nodiscard]] Eigen::Vector3d vehicle_angles(const RadarConfig& radar, const Eigen::Matrix3d& sensor_to_vehicle);

/// Writes everything but the header and the key figures. An axis of the sensor is observable once its std is clearly
/// below `prior_angle_std_rad`, where an axis of the vehicle that is not observable counts as not known at all.
void write_estimate(const RadarConfig& radar, const RadarEstimate& estimate, double prior_angle_std_rad,
                    AlignmentEstimate& out);

}  // namespace boresight::alignment
