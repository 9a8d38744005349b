#include "services/alignment_estimator/core/scan_detections.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::alignment {

namespace {

double usable_std(double stated, double configured) {
  return std::isfinite(stated) && stated > 0.0 ? stated : configured;
}

}  // namespace

void take_detections(const RadarScan& scan, const RadarConfig& radar, ScanDetections& out) {
  out.time_ns = scan.header.measurement_time_ns;
  out.count = 0;
  out.has_elevation = scan.has(scan_field::kElevation);
  const double width = static_cast<double>(scan.range_rate_max_mps) - static_cast<double>(scan.range_rate_min_mps);
  out.ambiguity_mps = scan.has(scan_field::kAmbiguity) && std::isfinite(width) && width > 0.0 ? width : 0.0;
  const bool has_stds = scan.has(scan_field::kStds);
  std::uint16_t unusable = detection_flag::kUntrusted;
  if (out.ambiguity_mps == 0.0) unusable |= detection_flag::kAmbiguous;
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    if ((scan.detection_flags[i] & unusable) != 0) continue;
    const double azimuth = scan.azimuth_rad[i], range_rate = scan.range_rate_mps[i];
    const double elevation = out.has_elevation ? scan.elevation_rad[i] : 0.0F;
    if (!std::isfinite(azimuth) || !std::isfinite(range_rate) || !std::isfinite(elevation)) continue;
    const std::size_t k = out.count++;
    out.range_m[k] = scan.range_m[i];
    out.azimuth_rad[k] = azimuth;
    out.elevation_rad[k] = elevation;
    out.range_rate_mps[k] = range_rate;
    const SensorNoise& noise = radar.noise;
    out.azimuth_std_rad[k] = usable_std(has_stds ? scan.azimuth_std_rad[i] : 0.0F, noise.azimuth_std_rad);
    out.elevation_std_rad[k] =
        usable_std(has_stds && out.has_elevation ? scan.elevation_std_rad[i] : 0.0F, noise.elevation_std_rad);
    out.range_rate_std_mps[k] = usable_std(has_stds ? scan.range_rate_std_mps[i] : 0.0F, noise.range_rate_std_mps);
  }
}

}  // namespace boresight::alignment
