#include "services/boresight/align/batch_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"
#include "services/alignment_estimator/core/write_estimate.hpp"
#include "services/boresight/align/stds.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::align {

namespace {

namespace batch_calibration = alignment::batch_calibration;

constexpr float kUnknownFloat = std::numeric_limits<float>::quiet_NaN();
/// Replaces a standard deviation that is not finite.
constexpr double kUnknownStd_rad = 1.0;

bool is_supported(const batch_calibration::Parameter& parameter) {
  return parameter.support == batch_calibration::Support::kSupported;
}

double std_of(const batch_calibration::Parameter& parameter) {
  return std::isfinite(parameter.std) ? std::hypot(parameter.std, parameter.spread) : kUnknownStd_rad;
}

alignment::RadarEstimate estimate_of(const MountingPose& pose, double speed_scale, double yaw, double pitch,
                                     double roll) {
  alignment::RadarEstimate e;
  e.speed_scale = speed_scale;
  e.sensor_to_vehicle = geometry::sensor_to_vehicle(pose, yaw, pitch, roll);
  return e;
}

/// Covariance of (k_v, d_x, d_y, d_z) from the stds of (α, β, γ). The method gives no correlations, so they are zero.
Eigen::Matrix4d covariance_of(const batch_calibration::Parameter& speed_scale,
                              const batch_calibration::RadarResult& radar, const Eigen::Matrix3d& sensor_to_vehicle) {
  const Eigen::Vector3d angles = geometry::euler_angles(sensor_to_vehicle);
  const Eigen::Matrix3d to_turn = geometry::euler_gradient_inverse(angles(0), angles(1));
  const Eigen::Vector3d stds(std_of(radar.yaw), std_of(radar.pitch), std_of(radar.roll));
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  covariance(0, 0) = std_of(speed_scale) * std_of(speed_scale);
  covariance.bottomRightCorner<3, 3>() = to_turn * stds.cwiseAbs2().asDiagonal() * to_turn.transpose();
  return covariance;
}

/// Only k_v and yaw can be observable. The planar roll model is no rotation: pitch and roll may be wrong by up to 1.5°
/// each, whatever their stds (docs/algorithms/published-alignment.md: (10)(11) against the exact rotation).
std::uint32_t observable_of(const batch_calibration::Parameter& speed_scale,
                            const batch_calibration::RadarResult& radar) {
  std::uint32_t bits = 0;
  if (is_supported(speed_scale)) bits |= alignment_axis::kSpeedScale;
  if (is_supported(radar.yaw)) bits |= alignment_axis::kYaw | alignment_axis::kVehicleYaw;
  return bits;
}

std::string support_of(const batch_calibration::Parameter& parameter, bool by_planar_model) {
  const std::string text = batch_calibration::to_text(parameter.support);
  if (!by_planar_model || !is_supported(parameter)) return text;
  return text + ", but by the planar roll model, which is no rotation: may be off by 1.5 degrees";
}

void add_series(const VehicleConfig& vehicle, const batch_calibration::Result& found, Result& result) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  for (const batch_calibration::Step& step : found.history) {
    Sample& sample = result.series.emplace_back();
    sample.x = static_cast<double>(step.iteration);
    sample.speed_scale = step.parameters[0];
    const bool is_last = &step == &found.history.back();
    sample.speed_scale_std = is_last ? result.speed_scale_std : kUnknown;
    for (std::size_t i = 0; i < vehicle.radars.size(); ++i) {
      const double* const angles = &step.parameters[1 + 3 * i];
      const auto e = estimate_of(vehicle.radars[i].mounting_pose, step.parameters[0], angles[0], angles[1], angles[2]);
      const Eigen::Vector4d form = alignment::vehicle_form(vehicle.radars[i], e).values;
      Sample::Radar& radar = sample.radars.emplace_back();
      radar.state = result.radars[i].estimate.state;
      radar.observable = result.radars[i].message.observable;
      radar.values = {form(0), form(1), form(2), form(3)};
      radar.stds.fill(kUnknown);
      if (is_last) radar.stds = result.radars[i].stds;
    }
  }
}

}  // namespace

void solve_batch_calibration(const VehicleConfig& vehicle, const std::vector<const ResidualSample*>& samples,
                             const batch_calibration::Config& settings, const batch_calibration::Progress& progress,
                             Result& result) {
  std::vector<batch_calibration::Recording> recordings;
  for (std::size_t i = 0; i < vehicle.radars.size(); ++i) {
    recordings.push_back(samples[i]->recording(vehicle.radars[i].mounting_pose, result.radars[i].measures_elevation));
  }
  const batch_calibration::Result found = batch_calibration::calibrate(recordings, settings, progress);
  result.problem = found.problem;
  result.x_is_iteration = true;
  for (std::size_t i = 0; i < vehicle.radars.size(); ++i) {
    RadarResult& radar = result.radars[i];
    const RadarConfig& config = vehicle.radars[i];
    if (found.ok) {
      const batch_calibration::RadarResult& r = found.radars[i];
      radar.estimate =
          estimate_of(config.mounting_pose, found.speed_scale.value, r.yaw.value, r.pitch.value, r.roll.value);
      radar.estimate.covariance = covariance_of(found.speed_scale, r, radar.estimate.sensor_to_vehicle);
      radar.estimate.state = r.used > 0 ? AlignmentState::kConverged : AlignmentState::kNoData;
      radar.estimate.observable = observable_of(found.speed_scale, r);
      radar.estimate.detections_used = r.used;
      radar.estimate.inlier_ratio =
          r.offered > 0 ? static_cast<double>(r.used) / static_cast<double>(r.offered) : kUnknownFloat;
      radar.support = {support_of(r.yaw, false), support_of(r.pitch, true), support_of(r.roll, true)};
    } else {
      radar.estimate = estimate_of(config.mounting_pose, 1.0, 0.0, 0.0, 0.0);
      radar.estimate.covariance = Eigen::Vector4d(1.0, 1.0, 1.0, 1.0).asDiagonal();
    }
    alignment::write_estimate(config, radar.estimate, 0.0, radar.message);
    radar.message.kpis.seconds_to_95_percent.fill(kUnknownFloat);
  }
  if (!found.ok) return;
  result.speed_scale = found.speed_scale.value;
  result.speed_scale_std = std_of(found.speed_scale);
  result.speed_scale_observable = is_supported(found.speed_scale);
  result.speed_scale_support = batch_calibration::to_text(found.speed_scale.support);
  for (RadarResult& radar : result.radars) {
    radar.stds = stds_of(alignment::vehicle_form(*vehicle.radar(radar.id), radar.estimate));
  }
  add_series(vehicle, found, result);
}

}  // namespace boresight::align
