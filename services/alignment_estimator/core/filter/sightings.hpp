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
};

/// An elevation that the sensor does not measure, anywhere in its field of view: mean of its cosine, and the variance
/// of that over the square of the mean. What stands above or below the beam's axis closes in more slowly than its
/// azimuth says.
struct UnknownElevation {
  double mean_cosine = 1.0;
  double relative_variance = 0.0;
};
[[nodiscard]] UnknownElevation unknown_elevation(const FieldOfView& view);

/// Fills `out`. `edge`: see FilterConfig::azimuth_std_edge; `angle_scale`: factor of the angles' variances as they
/// really are. Leaves out angles and range rates that nothing on a road has. No allocation.
void take_sightings(const ScanDetections& scan, const RadarConfig& radar, const UnknownElevation& unknown, double edge,
                    double angle_scale, Sightings& out);

}  // namespace boresight::alignment
