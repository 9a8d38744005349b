// Elevations that a radar does not measure: what they may be, and what that makes of range rates.
#pragma once

#include "services/common/vehicle/vehicle.hpp"

namespace boresight {

/// What elevations that are not measured take off range rates is anything from nothing to twice what is assumed, for
/// all radars alike; each radar's own share is as uncertain.
inline constexpr double kElevationExcessStd = 0.577;

/// What a sensor that measures no elevation may see: reflectors between the road and the clearance of what is built
/// over it, the lower the more of them, inside its vertical field of view. What stands above or below the sensor closes
/// in more slowly than its azimuth says, the nearer the more: far away nothing is high.
class UnknownElevation {
 public:
  /// `rotation_std_rad`: how far the sensor may look up or down from where it is meant to.
  UnknownElevation(const RadarConfig& radar, double rotation_std_rad);
  struct Cosine {
    double lowering;           ///< 1 − its mean
    double relative_variance;  ///< over the square of its mean
    double mean_sine;          ///< of the elevation
  };
  /// `range_m`: what is no distance counts as next to the sensor, where all of the field of view is possible.
  [[nodiscard]] Cosine at(double range_m) const;

 private:
  double height_m_;                                ///< of the sensor over the road
  double highest_m_;                               ///< over the road
  double lowest_sine_ = 0.0, highest_sine_ = 0.0;  ///< of elevations in view
};

}  // namespace boresight
