// How well a detection is measured: worse off boresight, where the aperture is seen from the side, and when it is weak.
#pragma once

#include <algorithm>
#include <cmath>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::simulator::radar {

/// Stds of a detection `excess_db` above the detection threshold. The configured ones hold on boresight at 10 dB; by
/// the Cramér–Rao bound they fall with the root of the power, down to half, and are at most twice as large.
[[nodiscard]] inline SensorNoise noise_of(const SensorNoise& nominal, double azimuth_rad, double elevation_rad,
                                          double excess_db) {
  const double weakness = std::clamp(std::pow(10.0, 0.05 * (10.0 - excess_db)), 0.5, 2.0);
  const double sideways = std::max(0.35, std::cos(azimuth_rad)), upwards = std::max(0.35, std::cos(elevation_rad));
  SensorNoise noise;
  noise.range_std_m = nominal.range_std_m * weakness;
  noise.azimuth_std_rad = nominal.azimuth_std_rad * weakness / sideways;
  noise.elevation_std_rad = nominal.elevation_std_rad * weakness / upwards;
  // Range rate suffers less: the aspect smears it over the beam's width only.
  noise.range_rate_std_mps = nominal.range_rate_std_mps * weakness / std::sqrt(sideways);
  return noise;
}

}  // namespace boresight::simulator::radar
