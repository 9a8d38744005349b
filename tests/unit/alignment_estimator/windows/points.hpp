// Points of the model for tests, and steps from them.
#pragma once

#include <cmath>
#include <numbers>

#include "services/alignment_estimator/core/windows/point.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::alignment::windows {

inline constexpr double kDegreeOfTest = std::numbers::pi / 180.0;

/// A radar that is turned as far as possible, with all parameters off.
inline Point some_point(double yaw_deg = 135.0, double pitch_deg = 5.0, double roll_deg = 180.0) {
  Point p;
  p.speed_scale = 1.02;
  p.rate_scale = -0.003;
  p.sensor_to_vehicle =
      geometry::sensor_to_vehicle(yaw_deg * kDegreeOfTest, pitch_deg * kDegreeOfTest, roll_deg * kDegreeOfTest);
  p.yaw_rate_bias_radps = 0.002;
  p.yaw_rate_gain = 0.01;
  p.slip_radps2pm = 0.004;
  p.stamp_s = 0.02;
  p.position_error_m = {0.03, -0.02};
  p.pitch_per_acceleration_radps2pm = 0.005;
  for (int k = 0; k < kKnots; ++k) p.curve_rad(k) = 0.002 * std::sin(1.3 * k);
  p.height_excess = 0.1;
  p.mirror_share = 0.2;
  return p;
}

/// The point that differs from `from` by `d`: the inverse of difference().
inline Point moved(const Point& from, const LocalVector& d) {
  Point p = from;
  p.speed_scale += d(local::kSpeedScale);
  p.rate_scale += d(local::kRateScale);
  p.sensor_to_vehicle = geometry::so3_exp(d.segment<3>(local::kRotation)) * from.sensor_to_vehicle;
  p.yaw_rate_bias_radps += d(local::kYawRateBias);
  p.yaw_rate_gain += d(local::kYawRateGain);
  p.slip_radps2pm += d(local::kSlip);
  p.stamp_s += d(local::kStamp);
  p.position_error_m += d.segment<2>(local::kPosition);
  p.pitch_per_acceleration_radps2pm += d(local::kPitchPerAcceleration);
  p.curve_rad += d.segment<kKnots>(local::kCurve);
  p.height_excess += d(local::kAbove);
  p.mirror_share += d(local::kMirror);
  return p;
}

}  // namespace boresight::alignment::windows
