// The place of a point in a scan, and the RCS that the sensor states for an echo.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "services/simulator/radar/antenna.hpp"
#include "services/simulator/radar/round_trip.hpp"
#include "services/simulator/radar/viewpoint.hpp"

namespace boresight::simulator::radar {

/// Range, angles and range rate of a point on the direct path. False if the point is out of view.
inline bool place_echo(const Viewpoint& view, const Antenna& antenna, const Eigen::Vector3d& position_m,
                       const Eigen::Vector3d& velocity_mps, Echo& echo) {
  constexpr double kNearest_m = 0.5;
  const Eigen::Vector3d path = position_m - view.position_m;
  echo.range_m = path.norm();
  if (echo.range_m < kNearest_m || echo.range_m > antenna.view().range_max_m) return false;
  const Eigen::Vector3d direction = path / echo.range_m;
  const Look look = antenna.look(view.sensor_to_world.transpose() * direction);
  echo.azimuth_rad = look.azimuth_rad;
  echo.elevation_rad = look.elevation_rad;
  echo.range_rate_mps = direction.dot(velocity_mps - view.velocity_mps);
  return look.inside;
}

/// Unit vector of an echo's direction, world axes.
[[nodiscard]] inline Eigen::Vector3d direction_of(const Viewpoint& view, const Echo& echo) {
  const double c = std::cos(echo.elevation_rad);
  return view.sensor_to_world *
         Eigen::Vector3d(c * std::cos(echo.azimuth_rad), c * std::sin(echo.azimuth_rad), std::sin(echo.elevation_rad));
}

/// Range rate of a stationary reflector in the direction of an echo.
[[nodiscard]] inline double stationary_rate(const Viewpoint& view, const Echo& echo) {
  return -direction_of(view, echo).dot(view.velocity_mps);
}

/// Received power less RCS, dB: range and pattern, for which the sensor corrects.
[[nodiscard]] inline double gain_db(const Echo& echo, const FieldOfView& fov) {
  return 2.0 * pattern_db(echo.azimuth_rad, echo.elevation_rad, fov) - 40.0 * std::log10(echo.range_m / 10.0);
}
[[nodiscard]] inline double rcs_of(const Echo& echo, const FieldOfView& fov) {
  return echo.power_db - gain_db(echo, fov);
}
inline void set_rcs(Echo& echo, double rcs_dbsm, const FieldOfView& fov) {
  echo.power_db = rcs_dbsm + gain_db(echo, fov);
}

/// A direct echo of a body, not a ghost or a false detection.
[[nodiscard]] inline bool is_direct(const Echo& echo) {
  return echo.truth.provenance == Provenance::kMoving || echo.truth.provenance == Provenance::kStationary;
}

}  // namespace boresight::simulator::radar
