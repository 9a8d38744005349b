#include "services/alignment_estimator/core/filter/sightings.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::alignment {

namespace {

/// Larger than any relative speed on a road.
constexpr double kMaxRangeRate_mps = 200.0;

}  // namespace

void take_sightings(const ScanDetections& scan, const RadarConfig& radar, const UnknownElevation& unknown, double edge,
                    double angle_scale, Sightings& out) {
  out.has_elevation = scan.has_elevation;
  out.ambiguity_mps = std::isfinite(scan.ambiguity_mps) && scan.ambiguity_mps > 0.1 ? scan.ambiguity_mps : 0.0;
  std::size_t n = 0;
  const std::size_t count = std::min(scan.count, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = scan.azimuth_rad[i], elevation = scan.elevation_rad[i], rate = scan.range_rate_mps[i];
    // This form also rejects values that are not numbers.
    if (!(std::abs(azimuth) <= M_PI && std::abs(elevation) < 1.5 && std::abs(rate) < kMaxRangeRate_mps)) continue;
    double azimuth_std = scan.azimuth_std_rad[i];
    const double elevation_std = scan.elevation_std_rad[i], rate_std = scan.range_rate_std_mps[i];
    if (!(azimuth_std > 0.0 && elevation_std > 0.0 && rate_std > 0.0)) continue;
    const double ca = std::cos(azimuth), sa = std::sin(azimuth);
    double slope = 0.0;
    // The effective aperture shrinks with the cosine. A σ stated by the sensor already contains this.
    if (azimuth_std == radar.noise.azimuth_std_rad && edge < 1.0) {
      azimuth_std /= std::max(ca, edge);
      if (ca > edge) slope = sa / ca;
    }
    azimuth_std = std::min(azimuth_std, 0.5);
    out.azimuth_rad[n] = azimuth;
    out.azimuth_variance[n] = azimuth_std * azimuth_std;
    out.azimuth_std_slope[n] = slope;
    out.range_rate_variance[n] = rate_std * rate_std;
    out.range_rate_mps[n] = rate;
    out.range_m[n] = scan.range_m[i];
    // The mean of a noisy angle's cosine is shorter by exp(−σ²/2).
    const double stretch_azimuth = 1.0 + 0.5 * angle_scale * out.azimuth_variance[n];
    if (scan.has_elevation) {
      const double bounded = std::min(elevation_std, 0.5);
      out.elevation_variance[n] = bounded * bounded;
      const double stretch = 1.0 + 0.5 * angle_scale * out.elevation_variance[n];
      const double ce = std::cos(elevation);
      out.x[n] = ce * ca * stretch_azimuth * stretch;
      out.y[n] = ce * sa * stretch_azimuth * stretch;
      out.z[n] = std::sin(elevation) * stretch;
      out.lowering[n] = out.lowering_variance[n] = out.mean_sine[n] = 0.0;
    } else {
      const UnknownElevation::Cosine cosine = unknown.at(scan.range_m[i]);
      out.elevation_variance[n] = 0.0;
      out.x[n] = (1.0 - cosine.lowering) * ca * stretch_azimuth;
      out.y[n] = (1.0 - cosine.lowering) * sa * stretch_azimuth;
      out.z[n] = 0.0;
      out.lowering[n] = cosine.lowering;
      out.lowering_variance[n] = cosine.relative_variance;
      out.mean_sine[n] = cosine.mean_sine;
    }
    ++n;
  }
  out.count = n;
}

}  // namespace boresight::alignment
