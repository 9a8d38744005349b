// The detections of a scan as they are judged: in the plane, with what is not known of them.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/corrected_scan.hpp"
#include "services/ghost_filter/core/reflector_map/stationary_grid.hpp"

namespace boresight::ghosts {

/// A detection, in the plane.
struct Measured {
  Eigen::Vector2d position_m, direction;
  double range_m, rate_mps;  ///< rate over ground
  double range_std_m, azimuth_std_rad, rate_std_mps;
  double still_std_mps;                             ///< of the range rate over ground of what stands still
  double rcs_dbsm;                                  ///< NaN: not measured
  std::uint32_t cell = StationaryGrid::kUnclaimed;  ///< of the map of what stands, in which it lies; or none
};

/// The sensor that a scan is of, in the vehicle frame; velocity over ground.
struct Viewpoint {
  Eigen::Vector2d sensor_m{0.0, 0.0}, sensor_velocity_mps{0.0, 0.0};
  double sensor_height_m = 0.0;
  double ego_speed_std_mps = 0.0, mounting_std_rad = 0.0;  ///< the latter of its yaw
  /// Of the range rate of what stands, for a line of sight straight up: by turns about the axes in the plane.
  double tilt_variance_m2ps2 = 0.0;
};
[[nodiscard]] Viewpoint viewpoint_of(const CorrectedScan& scan);

/// What the corrector told of a detection.
enum class Kind : std::uint8_t {
  kLeftOut,  ///< or its place in the plane or its range rate is not known
  kNotTold,  ///< whether it moves
  kStationary,
  kMoving
};
[[nodiscard]] Kind kind_of(const CorrectedScan& scan, std::size_t i);
/// One that is not left out; its cell is not known yet.
[[nodiscard]] Measured measured(const CorrectedScan& scan, std::size_t i, const Viewpoint& from);

/// For what a message may leave open, or not know.
[[nodiscard]] inline double positive_or(float value, double fallback) {
  return std::isfinite(value) && value > 0.0F ? static_cast<double>(value) : fallback;
}

}  // namespace boresight::ghosts
