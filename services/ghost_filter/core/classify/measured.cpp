#include "services/ghost_filter/core/classify/measured.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::ghosts {

namespace {

/// std::hypot costs ten times as much, for ranges of numbers that floats do not have.
double root_of_squares(double a, double b) {
  return std::sqrt(a * a + b * b);
}

double tilt_variance(const std::array<float, 6>& mounting, const Eigen::Vector2d& velocity_mps) {
  const double x = -velocity_mps.y(), y = velocity_mps.x();
  const double xx = mounting[0], xy = mounting[1], yy = mounting[3];
  const double variance = x * x * xx + 2.0 * x * y * xy + y * y * yy;
  return std::isfinite(variance) ? std::max(0.0, variance) : 0.0;
}

/// Of the range rate over ground of what stands: by what is not known of its elevation.
double still_variance_by_height(const CorrectedScan& scan, std::size_t i, const Viewpoint& from, const Measured& m) {
  const double height_m = scan.z_vehicle_m[i];
  if ((scan.flags & pipeline_flag::kNoElevation) != 0 || !std::isfinite(height_m)) return 0.0;
  // A part of the wave comes by way of the road, unresolved, from as far below it as the thing is above: that draws the
  // elevation to and fro by that share of the angle between both, which no sensor states.
  constexpr double kByRoad = 0.1;
  const double by_road_rad = kByRoad * 2.0 * std::max(0.0, height_m) / m.range_m;
  const double stated_rad = positive_or(scan.elevation_std_rad[i], 0.0);
  // The higher above the sensor, the more an elevation that is wrong takes out too much or too little own motion.
  const double rise = (height_m - from.sensor_height_m) / m.range_m;
  const double along = m.direction.dot(from.sensor_velocity_mps);
  return rise * rise *
         (along * along * (stated_rad * stated_rad + by_road_rad * by_road_rad) + from.tilt_variance_m2ps2);
}

}  // namespace

Viewpoint viewpoint_of(const CorrectedScan& scan) {
  const ScanGeometry& g = scan.geometry;
  Viewpoint from;
  from.sensor_m = {g.sensor_position_vehicle_m[0], g.sensor_position_vehicle_m[1]};
  from.sensor_velocity_mps = {g.sensor_velocity_vehicle_mps[0], g.sensor_velocity_vehicle_mps[1]};
  from.sensor_height_m = g.sensor_position_vehicle_m[2];
  from.ego_speed_std_mps = std::hypot(positive_or(g.ego_speed_std_mps, 0.05),
                                      positive_or(scan.speed_scale_std, 0.0) * static_cast<double>(g.ego_speed_mps));
  from.mounting_std_rad = std::sqrt(positive_or(scan.mounting_covariance[5], 0.0));
  from.tilt_variance_m2ps2 = tilt_variance(scan.mounting_covariance, from.sensor_velocity_mps);
  return from;
}

Kind kind_of(const CorrectedScan& scan, std::size_t i) {
  const std::uint16_t flags = scan.detection_flags[i];
  if ((flags & corrected_flag::kRejected) != 0 || !std::isfinite(scan.x_vehicle_m[i]) ||
      !std::isfinite(scan.y_vehicle_m[i]) || !std::isfinite(scan.range_rate_over_ground_mps[i]))
    return Kind::kLeftOut;
  if ((flags & corrected_flag::kMoving) != 0) return Kind::kMoving;
  return (flags & corrected_flag::kStationary) != 0 ? Kind::kStationary : Kind::kNotTold;
}

Measured measured(const CorrectedScan& scan, std::size_t i, const Viewpoint& from) {
  Measured m;
  m.position_m = {scan.x_vehicle_m[i], scan.y_vehicle_m[i]};
  const Eigen::Vector2d sight = m.position_m - from.sensor_m;
  m.range_m = std::max(0.1, sight.norm());
  m.direction = sight / m.range_m;
  m.rate_mps = scan.range_rate_over_ground_mps[i];
  m.range_std_m = positive_or(scan.range_std_m[i], 0.15);
  m.azimuth_std_rad = root_of_squares(positive_or(scan.azimuth_std_rad[i], 0.005), from.mounting_std_rad);
  const double across = m.direction.x() * from.sensor_velocity_mps.y() - m.direction.y() * from.sensor_velocity_mps.x();
  // A crooked radar takes the own motion out wrongly.
  m.rate_std_mps = root_of_squares(positive_or(scan.range_rate_std_mps[i], 0.05), across * from.mounting_std_rad);
  m.still_std_mps =
      std::sqrt(m.rate_std_mps * m.rate_std_mps + 0.06 * 0.06 + from.ego_speed_std_mps * from.ego_speed_std_mps +
                across * across * m.azimuth_std_rad * m.azimuth_std_rad + still_variance_by_height(scan, i, from, m));
  m.rcs_dbsm = (scan.fields & scan_field::kRcs) != 0 ? static_cast<double>(scan.rcs_dbsm[i])
                                                     : std::numeric_limits<double>::quiet_NaN();
  return m;
}

}  // namespace boresight::ghosts
