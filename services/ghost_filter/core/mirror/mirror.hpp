// Reflectors as mirrors, in the vehicle frame of a scan.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/evidence/config.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"
#include "services/ghost_filter/core/reflector_map/reflector.hpp"

namespace boresight::ghosts {

struct Mirror {
  Curve curve;
  Eigen::Matrix3d covariance;  ///< of shift, turn, curvature at the curve's origin
  double begin_m = 0.0, end_m = 0.0;
  double probability = 0.0;              ///< that it exists and mirrors
  const Occupancy* occupancy = nullptr;  ///< where along it something was detected
  double arc_shift_m = 0.0;              ///< arc length of the curve's origin in the occupancy's count

  /// Probability that the mirror is there at an arc length.
  [[nodiscard]] double probability_at(double arc_m) const {
    constexpr double kArcStd_m = 0.5;  // of the specular point
    return probability * occupancy->probability(arc_m + arc_shift_m, kArcStd_m);
  }
  /// Variance across the mirror at an arc length.
  [[nodiscard]] double offset_variance_m2(double arc_m) const {
    const Eigen::Vector3d row(1.0, arc_m, 0.5 * arc_m * arc_m);
    return std::max(0.0, row.dot(covariance * row));
  }
};

/// Long reflectors (rails, walls) mirror more often than short ones (hedges, parked cars): the probability is in
/// proportion to the length. The mirrors refer to the reflectors. `mirrors` keeps its capacity.
void place_mirrors(std::span<const Reflector> reflectors, const Odometry& odometry, const IntensityConfig& config,
                   std::vector<Mirror>& mirrors);

}  // namespace boresight::ghosts
