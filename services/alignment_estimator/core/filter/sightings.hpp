// Detections as unit vectors with variances: what the sums over a scan read.
#pragma once

#include <array>
#include <cstddef>

#include "interfaces/messages/header.hpp"
#include "services/alignment_estimator/core/scan_detections.hpp"

namespace boresight::alignment {

/// Columns of the first `count` usable detections in the sensor frame.
struct Sightings {
  std::size_t count = 0;
  double ambiguity_mps = 0.0;
  bool has_elevation = false;
  std::array<double, kMaxDetections> x, y, z;           ///< line of sight
  std::array<double, kMaxDetections> range_rate_mps;    //
  std::array<double, kMaxDetections> azimuth_variance;  ///< rad²
  std::array<double, kMaxDetections> elevation_variance;
  std::array<double, kMaxDetections> range_rate_variance;
  std::array<double, kMaxDetections> azimuth_std_slope;  ///< d ln σ(azimuth) / d azimuth
  // Of elevations that are not measured: 1 − the mean of their cosine, and its variance over the square of that mean.
  std::array<double, kMaxDetections> lowering;
  std::array<double, kMaxDetections> lowering_variance;
  std::array<double, kMaxDetections> mean_sine;  ///< of the elevation
};

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

/// Fills `out`. `edge`: see FilterConfig::azimuth_std_edge; `angle_scale`: factor of the angles' variances as they
/// really are. Leaves out angles and range rates that nothing on a road has. No allocation.
void take_sightings(const ScanDetections& scan, const RadarConfig& radar, const UnknownElevation& unknown, double edge,
                    double angle_scale, Sightings& out);

}  // namespace boresight::alignment
