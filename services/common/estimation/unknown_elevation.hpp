// Elevations that a radar does not measure: their distribution and its effect on range rates.
// Equations: docs/algorithms/alignment.md (A20)(A21).
#pragma once

#include "services/common/vehicle/vehicle.hpp"

namespace boresight {

/// Relative standard deviation of the reduction of range rates by elevations that are not measured: uniform from zero
/// to twice the assumed reduction. It applies to the error common to all radars, and again to each radar's own error.
inline constexpr double kElevationExcessStd = 0.577;

/// Distribution of elevations for a sensor that does not measure them: reflectors between the road and the clearance of
/// structures, more of them at lower heights, inside the vertical field of view. A stationary object above or below the
/// sensor approaches more slowly than its azimuth implies. The effect is largest at short range.
class UnknownElevation {
 public:
  /// `rotation_std_rad`: standard deviation of the sensor's elevation direction about its nominal one.
  UnknownElevation(const RadarConfig& radar, double rotation_std_rad);
  struct Cosine {
    double lowering;           ///< 1 − mean of the elevation's cosine
    double relative_variance;  ///< variance of the cosine over the square of its mean
    double mean_sine;          ///< mean of the elevation's sine
  };
  /// `range_m`: values that are no valid distance count as next to the sensor, where the whole field of view is
  /// possible.
  [[nodiscard]] Cosine at(double range_m) const;

 private:
  double height_m_;                                ///< of the sensor over the road
  double highest_m_;                               ///< over the road
  double lowest_sine_ = 0.0, highest_sine_ = 0.0;  ///< of elevations in view
};

}  // namespace boresight
