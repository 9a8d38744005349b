// Classified scans of point-like objects, as one of two radars sees them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/make_tracker.hpp"

namespace boresight::tracking {
constexpr std::int64_t kMillisecond = 1'000'000;

/// Radar 1 looks ahead, radar 2 is turned by 90° to the left.
inline VehicleConfig two_radars() {
  VehicleConfig vehicle;
  for (std::uint32_t id : {1u, 2u}) {
    RadarConfig radar;
    radar.id = id;
    radar.mounting_pose = {{3.6, 0.0, 0.5}, id == 1 ? 0.0 : 90.0 * kRadiansPerDegree, 0.0, 0.0};
    radar.field_of_view.azimuth_min_rad = -60.0 * kRadiansPerDegree;
    radar.field_of_view.azimuth_max_rad = 60.0 * kRadiansPerDegree;
    radar.field_of_view.range_max_m = 100.0;
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

class Scene {
 public:
  Scene() { std::memset(static_cast<void*>(scan.get()), 0, sizeof(ClassifiedScan)); }

  /// Begins a scan of the radar. The ego vehicle stands still, or drives with that speed and yaw rate.
  void begin(std::int64_t time_ns, std::uint32_t radar_id = 1, double ego_speed_mps = 0.0,
             double ego_yaw_rate_radps = 0.0) {
    scan->header.source_id = radar_id;
    scan->header.measurement_time_ns = time_ns;
    scan->number_of_valid_detections = 0;
    scan->flags = 0;
    scan->fields = scan_field::kElevation;
    scan->geometry = {};
    scan->geometry.sensor_position_vehicle_m = {3.6F, 0.0F, 0.5F};
    Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(scan->geometry.sensor_to_vehicle.data()) =
        geometry::sensor_to_vehicle(radar_id == 1 ? 0.0 : 90.0 * kRadiansPerDegree, 0.0, 0.0).cast<float>();
    scan->geometry.speed_scale = 1.0F;
    scan->geometry.ego_speed_mps = static_cast<float>(ego_speed_mps);
    scan->geometry.ego_yaw_rate_radps = static_cast<float>(ego_yaw_rate_radps);
    scan->geometry.sensor_velocity_vehicle_mps = {static_cast<float>(ego_speed_mps),
                                                  static_cast<float>(3.6 * ego_yaw_rate_radps), 0.0F};
  }
  void add(const Eigen::Vector2d& position_m, const Eigen::Vector2d& velocity_mps,
           Provenance provenance = Provenance::kMoving, double ghost_probability = 0.0) {
    const std::uint32_t i = scan->number_of_valid_detections++;
    const Eigen::Vector2d sight = position_m - Eigen::Vector2d(3.6, 0.0);
    scan->x_vehicle_m[i] = static_cast<float>(position_m.x());
    scan->y_vehicle_m[i] = static_cast<float>(position_m.y());
    scan->z_vehicle_m[i] = 0.7F;
    scan->range_m[i] = static_cast<float>(sight.norm());
    scan->azimuth_vehicle_rad[i] = static_cast<float>(std::atan2(sight.y(), sight.x()));
    scan->range_rate_over_ground_mps[i] = static_cast<float>(sight.normalized().dot(velocity_mps));
    scan->range_std_m[i] = 0.15F;
    scan->azimuth_std_rad[i] = 0.005F;
    scan->range_rate_std_mps[i] = 0.05F;
    scan->provenance[i] = provenance;
    scan->detection_flags[i] =
        provenance == Provenance::kStationary ? corrected_flag::kStationary : corrected_flag::kMoving;
    const auto unreal = static_cast<float>(ghost_probability);
    scan->set_probabilities(i, {1.0F - unreal, 0.0F, 0.0F, 0.0F, unreal, 0.0F});
    // No filter is certain: on simulated drives most ratios of real detections lie below this.
    constexpr double kUsual = 2.0;
    const double ratio = std::log((1.0 - ghost_probability) / ghost_probability);
    scan->moving_log_likelihood_ratio[i] = static_cast<float>(std::clamp(ratio, -kUsual, kUsual));
  }
  std::unique_ptr<ClassifiedScan> scan = std::make_unique<ClassifiedScan>();
};

}  // namespace boresight::tracking
