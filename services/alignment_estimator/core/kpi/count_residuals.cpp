#include "services/alignment_estimator/core/kpi/count_residuals.hpp"

#include <cmath>

#include "services/common/geometry/frames.hpp"

namespace boresight::alignment {

void count_residuals(const RadarConfig& radar, const RadarEstimate& estimate, const ScanDetections& scan,
                     const EgoSample& ego, std::span<const double> predicted, double gate_sigma,
                     ResidualStatistics& statistics) {
  const std::array<double, 3>& position = radar.mounting_pose.position_m;
  const Eigen::Matrix3d to_sensor = estimate.sensor_to_vehicle.transpose();
  const Eigen::Vector3d velocity =
      to_sensor * geometry::sensor_velocity(estimate.speed_scale, ego.speed_mps, ego.yaw_rate_radps, position);
  // Range-rate error per unit error of the two ego signals.
  const Eigen::Vector3d by_speed = to_sensor.col(0) * ego.speed_std_mps;
  const Eigen::Vector3d by_yaw_rate =
      to_sensor * Eigen::Vector3d(-position[1], position[0], 0.0) * ego.yaw_rate_std_radps;
  const Eigen::Vector3d nominal_velocity = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0).transpose() *
                                           geometry::sensor_velocity(1.0, ego.speed_mps, ego.yaw_rate_radps, position);
  const auto wrapped = [&scan](double residual) {
    return scan.ambiguity_mps > 0.0 ? std::remainder(residual, scan.ambiguity_mps) : residual;
  };
  const double scale = estimate.angle_noise_scale;
  for (std::size_t i = 0; i < scan.count; ++i) {
    const double ca = std::cos(scan.azimuth_rad[i]), sa = std::sin(scan.azimuth_rad[i]);
    const double ce = std::cos(scan.elevation_rad[i]), se = std::sin(scan.elevation_rad[i]);
    const Eigen::Vector3d direction(ce * ca, ce * sa, se);
    const double residual = wrapped(scan.range_rate_mps[i] - predicted[i]);
    const double azimuth_std = scale * scan.azimuth_std_rad[i], elevation_std = scale * scan.elevation_std_rad[i];
    const double by_azimuth = velocity.dot(Eigen::Vector3d(-ce * sa, ce * ca, 0.0)) * azimuth_std;
    const double by_elevation = velocity.dot(Eigen::Vector3d(-se * ca, -se * sa, ce)) * elevation_std;
    // Second-order term, 1 − cos β; the only one if the elevation is not measured.
    const double by_cosine = 0.7 * velocity.dot(direction) * elevation_std * elevation_std;
    const double variance = scan.range_rate_std_mps[i] * scan.range_rate_std_mps[i] + by_azimuth * by_azimuth +
                            by_elevation * by_elevation + by_cosine * by_cosine + std::pow(by_speed.dot(direction), 2) +
                            std::pow(by_yaw_rate.dot(direction), 2);
    if (!(residual * residual < gate_sigma * gate_sigma * variance)) {
      statistics.add_outlier();
      continue;
    }
    statistics.add_inlier(residual, wrapped(scan.range_rate_mps[i] + direction.dot(nominal_velocity)));
  }
}

}  // namespace boresight::alignment
