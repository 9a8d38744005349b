#include "services/boresight/report/truth_table.hpp"

#include <cmath>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::report {

Truth truth_of(const DriveTruth& drive, const VehicleConfig& vehicle) {
  Truth truth;
  for (const RadarConfig& radar : vehicle.radars) {
    if (std::isfinite(drive.speed_scale)) truth.speed_scales[radar.id] = drive.speed_scale_seen_by(radar.id);
  }
  for (const auto& [id, radar] : drive.radars) {
    if (radar.scans) truth.scans[id] = *radar.scans;
    if (std::isfinite(radar.yaw_rad)) truth.yaw_rad[id] = radar.yaw_rad;
    const RadarConfig* const config = vehicle.radar(id);
    if (config == nullptr || !std::isfinite(radar.yaw_rad + radar.pitch_rad + radar.roll_rad)) continue;
    const MountingPose& nominal = config->mounting_pose;
    const Eigen::Matrix3d turn = geometry::sensor_to_vehicle(nominal, radar.yaw_rad, radar.pitch_rad, radar.roll_rad) *
                                 geometry::sensor_to_vehicle(nominal, 0.0, 0.0, 0.0).transpose();
    const Eigen::Vector3d angles = geometry::fixed_axes_angles(turn);
    truth.vehicle_rad[id] = {angles(0), angles(1), angles(2)};
  }
  return truth;
}

}  // namespace boresight::report
