// Detections as unit vectors with variances: what the sums over a scan read.
#pragma once

#include <array>
#include <cstddef>

#include "interfaces/messages/header.hpp"
#include "services/alignment_estimator/core/scan_detections.hpp"
#include "services/common/estimation/unknown_elevation.hpp"

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

/// Fills `out`. `edge`: see FilterConfig::azimuth_std_edge; `angle_scale`: factor of the angles' variances as they
/// really are. Leaves out angles and range rates that nothing on a road has. No allocation.
void take_sightings(const ScanDetections& scan, const RadarConfig& radar, const UnknownElevation& unknown, double edge,
                    double angle_scale, Sightings& out);

}  // namespace boresight::alignment
