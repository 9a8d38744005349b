// A radar with a known error on a drive at a known speed: stationary points all around, outliers, and noise with the
// stated std.
#pragma once

#include <cmath>
#include <memory>
#include <random>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

struct SyntheticDrive {
  double yaw_rad = 2.0 * kRadiansPerDegree;
  double speed_scale = 1.01;
  double outliers = 0.2;
  std::uint32_t detections = 60;
  double azimuth_centre_rad = 0.0;
  double azimuth_limit_rad = 1.1;  ///< to both sides of the centre
  double elevation_limit_rad = 0.0;
  bool measures_elevation = true;
  double turning_radps = 0.08;  ///< amplitude of the yaw rate
  double mount_yaw_rad = 45.0 * kRadiansPerDegree;
  double mount_pitch_rad = 0.0;
  double mount_roll_rad = 0.0;
  double azimuth_std_rad = 0.2 * kRadiansPerDegree;
  double range_rate_std_mps = 0.05;
  double speed_std_mps = 0.0;  ///< of each scan's speed signal
  double yaw_rate_std_radps = 0.0;
  bool mirrored = false;

  [[nodiscard]] RadarConfig radar() const {
    RadarConfig r;
    r.id = 1;
    const double side = mirrored ? -1.0 : 1.0;
    r.mounting_pose = {{3.6, side * 0.7, 0.5}, side * mount_yaw_rad, mount_pitch_rad, side * mount_roll_rad};
    r.noise = {.range_std_m = 0.1,
               .azimuth_std_rad = azimuth_std_rad,
               .elevation_std_rad = 0.2 * kRadiansPerDegree,
               .range_rate_std_mps = range_rate_std_mps};
    r.cycle_time_s = 0.05;
    r.field_of_view.elevation_min_rad = -elevation_limit_rad;
    r.field_of_view.elevation_max_rad = elevation_limit_rad;
    return r;
  }
  [[nodiscard]] double speed_mps(int scan) const { return 15.0 + 5.0 * std::sin(0.02 * scan); }
  [[nodiscard]] double yaw_rate_radps(int scan) const {
    return (mirrored ? -1.0 : 1.0) * turning_radps * std::sin(0.031 * scan);
  }
};

/// The scans of a drive, one after the other.
class Synthesizer {
 public:
  Synthesizer(const SyntheticDrive& drive, unsigned seed) : drive_(drive), random_(seed) {}

  void next() {
    std::uniform_real_distribution<double> share(0.0, 1.0),
        azimuth(drive_.azimuth_centre_rad - drive_.azimuth_limit_rad,
                drive_.azimuth_centre_rad + drive_.azimuth_limit_rad),
        stray(-8.0, 8.0);
    std::normal_distribution<double> normal(0.0, 1.0);
    const RadarConfig radar = drive_.radar();
    const double side = drive_.mirrored ? -1.0 : 1.0;
    const double speed = drive_.speed_mps(index_), yaw_rate = drive_.yaw_rate_radps(index_);
    const Eigen::Matrix3d rotation = geometry::sensor_to_vehicle(radar.mounting_pose, side * drive_.yaw_rad, 0.0, 0.0);
    const Eigen::Vector3d velocity =
        geometry::sensor_velocity(drive_.speed_scale, speed, yaw_rate, radar.mounting_pose.position_m);
    scan->header = {};
    scan->header.source_id = 1;
    scan->header.measurement_time_ns = 1'000'000'000 + index_ * 50'000'000LL;
    scan->fields = drive_.measures_elevation ? scan_field::kElevation : 0;
    scan->number_of_valid_detections = drive_.detections;
    for (std::uint32_t i = 0; i < drive_.detections; ++i) {
      const double a = azimuth(random_);
      const double e =
          drive_.elevation_limit_rad > 0.0 ? drive_.elevation_limit_rad * (2.0 * share(random_) - 1.0) : 0.0;
      double range_rate = -(rotation * geometry::direction(side * a, e)).dot(velocity);
      if (share(random_) < drive_.outliers) range_rate += stray(random_);
      scan->range_m[i] = static_cast<float>(10.0 + 50.0 * share(random_));
      scan->azimuth_rad[i] = static_cast<float>(side * (a + drive_.azimuth_std_rad * normal(random_)));
      scan->elevation_rad[i] = static_cast<float>(e);
      scan->range_rate_mps[i] = static_cast<float>(range_rate + drive_.range_rate_std_mps * normal(random_));
      scan->detection_flags[i] = 0;
    }
    ego = {true,
           false,
           speed + drive_.speed_std_mps * normal(random_),
           std::max(1e-3, drive_.speed_std_mps),
           yaw_rate + drive_.yaw_rate_std_radps * normal(random_),
           std::max(1e-5, drive_.yaw_rate_std_radps)};
    ++index_;
  }

  std::unique_ptr<RadarScan> scan = std::make_unique<RadarScan>();
  EgoSample ego;

 private:
  SyntheticDrive drive_;
  std::mt19937 random_;
  int index_ = 0;
};

}  // namespace boresight::alignment
