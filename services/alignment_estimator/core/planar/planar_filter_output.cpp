// What the planar filter publishes of its state.
#include <algorithm>

#include "services/alignment_estimator/core/planar/planar_filter.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::planar {

Eigen::Vector4d PlanarFilter::parameters(std::size_t radar) const {
  Eigen::Vector4d b;
  b << state_(kSpeedScaleColumn), state_.segment<3>(column_of(radar));
  return b;
}

Eigen::Matrix4d PlanarFilter::covariance(std::size_t radar) const {
  Eigen::Matrix4d out;
  const Eigen::Index first = column_of(radar);
  out(0, 0) = covariance_(kSpeedScaleColumn, kSpeedScaleColumn);
  out.block<3, 1>(1, 0) = covariance_.block<3, 1>(first, kSpeedScaleColumn);
  out.block<1, 3>(0, 1) = covariance_.block<1, 3>(kSpeedScaleColumn, first);
  out.bottomRightCorner<3, 3>() = covariance_.block<3, 3>(first, first);
  // Without elevation, k_v contains the cosine of an unknown pitch.
  if (!radars_[radar].has_elevation) out(0, 0) += square(0.5 * square(config_.prior_angle_std_rad));
  return out;
}

void PlanarFilter::predict(std::size_t index, const ScanDetections& scan, const EgoSample& ego,
                           std::span<double> out) const {
  const std::size_t count = std::min({scan.count, kMaxDetections, out.size()});
  if (index >= radars_.size()) {
    std::fill_n(out.begin(), count, 0.0);
    return;
  }
  Parameters at;
  at << state_(kSpeedScaleColumn), 0.0, state_.segment<3>(column_of(index));
  const Setting setting{radars_[index].nominal, ego.speed_mps, ego.yaw_rate_radps};
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = row_of(setting, at, scan.azimuth_rad[i], scan.elevation_rad[i]).value_mps;
  }
}

RadarEstimate PlanarFilter::estimate(std::size_t index) const {
  RadarEstimate out;
  if (index >= radars_.size()) return out;
  const Radar& radar = radars_[index];
  const Eigen::Vector4d b = parameters(index);
  out.state = radar.state;
  out.speed_scale = b(0);
  out.sensor_to_vehicle = geometry::sensor_to_vehicle(radar.nominal, b(1), b(2), b(3));
  Eigen::Matrix4d to_vehicle = Eigen::Matrix4d::Identity();
  to_vehicle.bottomRightCorner<3, 3>() =
      geometry::euler_gradient_inverse(radar.nominal.yaw_rad + b(1), radar.nominal.pitch_rad + b(2));
  out.covariance = to_vehicle * covariance(index) * to_vehicle.transpose();
  // An axis is observable once the data have reduced its σ clearly below the prior.
  const auto learnt = [&](Eigen::Index i, double prior_std) {
    return radar.running && out.covariance(i, i) < 0.25 * square(prior_std);
  };
  if (learnt(0, config_.prior_speed_scale_std)) out.observable |= alignment_axis::kSpeedScale;
  if (learnt(1, config_.prior_angle_std_rad)) out.observable |= alignment_axis::kVehicleRoll;
  if (learnt(2, config_.prior_angle_std_rad)) out.observable |= alignment_axis::kVehiclePitch;
  if (learnt(3, config_.prior_angle_std_rad)) out.observable |= alignment_axis::kVehicleYaw;
  out.inlier_ratio = radar.inlier_ratio;
  out.scans_used = radar.scans_used;
  out.detections_used = radar.detections_used;
  out.seconds_of_drive = radar.seconds_of_drive;
  return out;
}

}  // namespace boresight::alignment::planar
