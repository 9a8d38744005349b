// Measurement noise of a detection. It grows off boresight, where the projected aperture is smaller, and for weak
// echoes.
#pragma once

#include <algorithm>
#include <cmath>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::simulator::radar {

/// Standard deviations of a detection `excess_db` above the detection threshold. The configured values hold on
/// boresight at 10 dB. By the Cramér–Rao bound they fall with the root of the power, between half and twice the
/// configured value.
[[nodiscard]] inline SensorNoise noise_of(const SensorNoise& nominal, double azimuth_rad, double elevation_rad,
                                          double excess_db) {
  const double weakness = std::clamp(std::pow(10.0, 0.05 * (10.0 - excess_db)), 0.5, 2.0);
  const double sideways = std::max(0.35, std::cos(azimuth_rad)), upwards = std::max(0.35, std::cos(elevation_rad));
  SensorNoise noise;
  noise.range_std_m = nominal.range_std_m * weakness;
  noise.azimuth_std_rad = nominal.azimuth_std_rad * weakness / sideways;
  noise.elevation_std_rad = nominal.elevation_std_rad * weakness / upwards;
  // The effect of the aspect on range rate is smaller.
  noise.range_rate_std_mps = nominal.range_rate_std_mps * weakness / std::sqrt(sideways);
  return noise;
}

}  // namespace boresight::simulator::radar
