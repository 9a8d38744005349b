#include "services/tracker/core/visibility.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

bool can_see(const RadarConfig& radar, const ScanGeometry& geometry, const TrackedObject& track,
             std::span<const TrackedObject> tracks, double blind_range_rate_mps) {
  const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> rotation(geometry.sensor_to_vehicle.data());
  const Eigen::Vector3d sight(track.state.mean(0) - static_cast<double>(geometry.sensor_position_vehicle_m[0]),
                              track.state.mean(1) - static_cast<double>(geometry.sensor_position_vehicle_m[1]), 0.0);
  // Who moves across the line of sight has no range rate over ground and looks stationary.
  const double range_rate = sight.head<2>().normalized().dot(track.state.mean.segment<2>(2));
  if (std::abs(range_rate) < blind_range_rate_mps) return false;
  const Eigen::Vector3d in_sensor = rotation.cast<double>().transpose() * sight;
  const double azimuth = std::atan2(in_sensor.y(), in_sensor.x());
  const FieldOfView& view = radar.field_of_view;
  if (azimuth <= view.azimuth_min_rad || azimuth >= view.azimuth_max_rad || sight.norm() >= view.range_max_m) {
    return false;
  }
  // Behind a vehicle that is surely there it is hidden, to this radar.
  constexpr double kSurelyThere = 0.95;
  const Eigen::Vector2d to = track.state.mean.head<2>(), from = to - sight.head<2>();
  return std::none_of(tracks.begin(), tracks.end(), [&](const TrackedObject& other) {
    return &other != &track && other.confirmed && other.existence > kSurelyThere && !other.extent.is_small &&
           other.extent.hides(other.state.mean.head<2>(), from, to);
  });
}

}  // namespace boresight::tracking
