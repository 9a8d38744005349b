// Reflectors as mirrors, in the vehicle frame of a scan.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/evidence/config.hpp"
#include "services/ghost_filter/core/odometry.hpp"
#include "services/ghost_filter/core/reflectors/reflector_map.hpp"

namespace boresight::ghosts {

/// A straight mirror from `start_m` along `tangent`.
struct Mirror {
  Eigen::Vector2d start_m{0.0, 0.0};
  Eigen::Vector2d tangent{1.0, 0.0};  ///< unit
  double length_m = 0.0;
  double probability = 0.0;  ///< that it mirrors
  double middle_variance_m2 = 0.0, turn_variance_rad2 = 0.0;

  [[nodiscard]] Eigen::Vector2d normal() const { return {-tangent.y(), tangent.x()}; }
  /// Variance across the mirror at an arc length: of a fitted line (G4).
  [[nodiscard]] double offset_variance_m2(double arc_m) const {
    const double from_middle_m = arc_m - 0.5 * length_m;
    return middle_variance_m2 + from_middle_m * from_middle_m * turn_variance_rad2;
  }
};

/// Long reflectors (rails, walls) mirror more often than short ones (hedges, parked cars): the probability is in
/// proportion to the length. `mirrors` keeps its capacity.
void place_mirrors(std::span<const Segment> reflectors, const Odometry& odometry, const IntensityConfig& config,
                   std::vector<Mirror>& mirrors);

/// The way from the sensor over a mirror to a place (G5), (G6).
struct MirrorPath {
  double arc_m;               ///< of W, where the wave turns
  double first_m, second_m;   ///< |W−S|, |T−W|
  Eigen::Vector2d departure;  ///< u: from the sensor to W, unit
  Eigen::Vector2d arrival;    ///< d: from W to T, unit
};
/// Nothing if both do not lie on the same side of the mirror, or the wave would turn beyond its ends.
[[nodiscard]] std::optional<MirrorPath> path_over(const Mirror& mirror, const Eigen::Vector2d& sensor_m,
                                                  const Eigen::Vector2d& place_m);

}  // namespace boresight::ghosts
