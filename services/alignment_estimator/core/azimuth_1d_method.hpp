// One yaw filter a radar, as a method.
#pragma once

#include <vector>

#include "services/alignment_estimator/core/azimuth_1d.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/range_rate_model.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

class Azimuth1dMethod : public Method {
 public:
  Azimuth1dMethod(const VehicleConfig& vehicle, const Config& config) : vehicle_(vehicle), config_(config) {
    filters_.reserve(vehicle.radars.size());
    for (const RadarConfig& radar : vehicle.radars) filters_.emplace_back(radar, config);
  }

  void process(std::size_t radar, const ScanDetections& scan, const EgoSample& ego) override {
    filters_[radar].process(scan, ego);
  }

  [[nodiscard]] RadarEstimate estimate(std::size_t radar) const override {
    const YawFilter& filter = filters_[radar];
    const double tilt_variance = config_.prior_yaw_std_rad * config_.prior_yaw_std_rad;
    const Eigen::Matrix2d known = filter.covariance();
    RadarEstimate e;
    e.state = filter.state();
    e.speed_scale = filter.speed_scale();
    e.sensor_to_vehicle = geometry::so3_exp({0.0, 0.0, filter.yaw_rad()}) *
                          geometry::sensor_to_vehicle(vehicle_.radars[radar].mounting_pose, 0.0, 0.0, 0.0);
    e.covariance.diagonal() << known(0, 0), tilt_variance, tilt_variance, known(1, 1);
    e.covariance(0, 3) = e.covariance(3, 0) = known(0, 1);
    // An axis counts as observable once the data say clearly more than the prior did.
    const double scale_variance = config_.prior_speed_scale_std * config_.prior_speed_scale_std;
    if (known(0, 0) < 0.25 * scale_variance) e.observable |= alignment_axis::kSpeedScale;
    if (known(1, 1) < 0.25 * tilt_variance) e.observable |= alignment_axis::kVehicleYaw;
    e.inlier_ratio = filter.inlier_ratio();
    e.scans_used = filter.scans_used();
    e.detections_used = filter.detections_used();
    e.seconds_of_drive = filter.seconds_of_drive();
    return e;
  }

  void predict(std::size_t radar, const ScanDetections& scan, const EgoSample& ego,
               std::span<double> out) const override {
    const MountingPose& pose = vehicle_.radars[radar].mounting_pose;
    const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(pose, 0.0, 0.0, 0.0);
    const ScanMotion motion{ego.speed_mps, ego.yaw_rate_radps, pose.position_m[0], pose.position_m[1]};
    for (std::size_t i = 0; i < scan.count; ++i) {
      const Eigen::Vector3d direction = nominal * geometry::direction(scan.azimuth_rad[i], scan.elevation_rad[i]);
      out[i] = predict_range_rate(direction, motion, filters_[radar].speed_scale(), filters_[radar].yaw_rad())
                   .range_rate_mps;
    }
  }

 private:
  VehicleConfig vehicle_;
  Config config_;
  std::vector<YawFilter> filters_;
};

}  // namespace boresight::alignment
