// The published estimate of a radar, and the range rates that it predicts.
#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/filter/robust_filter.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

/// An axis counts as known below this share of the prior's σ.
constexpr double kLearntShare = 1.0 / 3.0;

}  // namespace

/// Variance of the difference between the observed yaw and the yaw of the rotation. With an unknown roll r and pitch p
/// (about the vehicle's axes) they differ by r·p/2. Reflectors at ψ from the vehicle's x axis with an unmeasured mean
/// elevation ε add ε·(r·cos ψ + p·sin ψ). Neither error decreases with driving time.
double RobustFilter::second_order_yaw_variance(std::size_t index) const {
  const Eigen::Index first = column::of_radar(index);
  const double roll = state_.covariance(first, first), pitch = state_.covariance(first + 1, first + 1);
  const Eigen::Vector2d ahead = state_.sensor_to_vehicle[index].topLeftCorner<2, 1>();
  const double tilt =
      (ahead.x() * ahead.x() * roll + 2.0 * ahead.x() * ahead.y() * state_.covariance(first, first + 1) +
       ahead.y() * ahead.y() * pitch) /
      std::max(ahead.squaredNorm(), 1e-6);
  // The mean elevation is as uncertain as the reduction of the range rates.
  const double mean_square = square(radars_[index].mean_sine) * (1.0 + square(kElevationExcessStd));
  return mean_square * std::max(tilt, 0.0) + 0.25 * roll * pitch;
}

RadarEstimate RobustFilter::estimate(std::size_t index) const {
  RadarEstimate out;
  if (index >= radars_.size()) return out;
  const Radar& radar = radars_[index];
  const Eigen::Index first = column::of_radar(index);
  out.state = radar.state;
  out.speed_scale = state_.speed_scale;
  out.sensor_to_vehicle = state_.sensor_to_vehicle[index];
  const std::array<Eigen::Index, 4> rows{column::kSpeedScale, first, first + 1, first + 2};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      out.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = state_.covariance(rows[i], rows[j]);
    }
  }
  out.covariance(3, 3) += second_order_yaw_variance(index);
  // An axis is observable once the data have reduced its σ clearly below the prior.
  const auto learnt = [&](Eigen::Index row, double prior_std) {
    return state_.covariance(row, row) < square(kLearntShare * prior_std);
  };
  const bool known = radar.phase != Phase::kStarting || radar.remembered;
  if (known && learnt(rows[0], config_.prior_speed_scale_std)) out.observable |= alignment_axis::kSpeedScale;
  if (known && learnt(rows[1], config_.prior_rotation_std_rad)) out.observable |= alignment_axis::kVehicleRoll;
  if (known && learnt(rows[2], config_.prior_rotation_std_rad)) out.observable |= alignment_axis::kVehiclePitch;
  if (known && learnt(rows[3], config_.prior_rotation_std_rad)) out.observable |= alignment_axis::kVehicleYaw;
  if (learnt(column::kYawRateBias, config_.prior_yaw_rate_bias_std_radps)) {
    out.observable |= alignment_axis::kYawRateBias;
  }
  if (learnt(column::kSlip, config_.prior_slip_coefficient_std_radps2pm)) out.observable |= alignment_axis::kSlip;
  out.yaw_rate_bias_radps = state_.yaw_rate_bias_radps;
  out.yaw_rate_bias_std_radps = std::sqrt(state_.covariance(column::kYawRateBias, column::kYawRateBias));
  out.slip_coefficient_radps2pm = state_.slip_radps2pm;
  out.slip_coefficient_std_radps2pm = std::sqrt(state_.covariance(column::kSlip, column::kSlip));
  out.angle_noise_scale = std::sqrt(radar.noise.angle_variance_factor());
  out.inlier_ratio = std::max(0.0, radar.inlier_ratio);
  out.scans_used = radar.scans_used;
  out.detections_used = radar.detections_used;
  out.seconds_of_drive = radar.seconds_of_drive;
  out.step_change = radar.step_change;
  return out;
}

void RobustFilter::predict(std::size_t index, const ScanDetections& scan, const EgoSample& ego,
                           std::span<double> out) const {
  const std::size_t count = std::min(scan.count, out.size());
  if (index >= radars_.size()) {
    std::fill_n(out.begin(), count, 0.0);
    return;
  }
  const Radar& radar = radars_[index];
  const ScanMotion3d motion{ego.speed_mps, ego.yaw_rate_radps, 0.0};
  const Eigen::Vector3d g =
      sensor_velocity(state_, Eigen::Vector4d::Zero(), index, radar.config.mounting_pose.position_m, motion).g;
  for (std::size_t i = 0; i < count; ++i) {
    const double mean_cosine = scan.has_elevation ? 1.0 : 1.0 - radar.unknown.at(scan.range_m[i]).lowering;
    out[i] = -mean_cosine * geometry::direction(scan.azimuth_rad[i], scan.elevation_rad[i]).dot(g);
  }
}

}  // namespace boresight::alignment
