// Values of the parameters of one radar's model: a point of linearisation.
#pragma once

#include <Eigen/Core>

#include "services/alignment_estimator/core/windows/columns.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::windows {

struct Point {
  double speed_scale = 1.0;
  double rate_scale = 0.0;
  Eigen::Matrix3d sensor_to_vehicle = Eigen::Matrix3d::Identity();  ///< load included
  double yaw_rate_bias_radps = 0.0;
  double yaw_rate_gain = 0.0;
  double slip_radps2pm = 0.0;
  double stamp_s = 0.0;
  Eigen::Vector2d position_error_m{0.0, 0.0};
  double pitch_per_acceleration_radps2pm = 0.0;
  Eigen::Matrix<double, kKnots, 1> curve_rad = Eigen::Matrix<double, kKnots, 1>::Zero();
  double height_excess = 0.0;
  double mirror_share = 0.0;
};

/// The local parameters that lead from `from` to `to`.
[[nodiscard]] inline LocalVector difference(const Point& from, const Point& to) {
  LocalVector d;
  d(local::kSpeedScale) = to.speed_scale - from.speed_scale;
  d(local::kRateScale) = to.rate_scale - from.rate_scale;
  d.segment<3>(local::kRotation) = geometry::so3_log(to.sensor_to_vehicle * from.sensor_to_vehicle.transpose());
  d(local::kYawRateBias) = to.yaw_rate_bias_radps - from.yaw_rate_bias_radps;
  d(local::kYawRateGain) = to.yaw_rate_gain - from.yaw_rate_gain;
  d(local::kSlip) = to.slip_radps2pm - from.slip_radps2pm;
  d(local::kStamp) = to.stamp_s - from.stamp_s;
  d.segment<2>(local::kPosition) = to.position_error_m - from.position_error_m;
  d(local::kPitchPerAcceleration) = to.pitch_per_acceleration_radps2pm - from.pitch_per_acceleration_radps2pm;
  d.segment<kKnots>(local::kCurve) = to.curve_rad - from.curve_rad;
  d(local::kAbove) = to.height_excess - from.height_excess;
  d(local::kMirror) = to.mirror_share - from.mirror_share;
  return d;
}

}  // namespace boresight::alignment::windows
