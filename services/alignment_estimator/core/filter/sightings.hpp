// Detections as unit vectors with variances: the input of the sums over a scan.
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
  std::array<double, kMaxDetections> azimuth_rad;       //
  std::array<double, kMaxDetections> range_rate_mps;    //
  std::array<double, kMaxDetections> range_m;           //
  std::array<double, kMaxDetections> azimuth_variance;  ///< rad²
  std::array<double, kMaxDetections> elevation_variance;
  std::array<double, kMaxDetections> range_rate_variance;
  std::array<double, kMaxDetections> azimuth_std_slope;  ///< d ln σ(azimuth) / d azimuth
  // For unmeasured elevations: 1 − mean cosine, and its variance over the square of the mean cosine.
  std::array<double, kMaxDetections> lowering;
  std::array<double, kMaxDetections> lowering_variance;
  std::array<double, kMaxDetections> mean_sine;  ///< of the elevation
};

/// Fills `out`. `edge`: see FilterConfig::azimuth_std_edge; `angle_scale`: estimated factor of the angles' variances.
/// Rejects angles and range rates that are impossible on a road. No allocation.
void take_sightings(const ScanDetections& scan, const RadarConfig& radar, const UnknownElevation& unknown, double edge,
                    double angle_scale, Sightings& out);

}  // namespace boresight::alignment
