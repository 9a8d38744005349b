// The road as a mirror. Direct and ground path interfere: the power of a target depends on its height and distance, and
// its apparent elevation shifts. Where only the ground path is free (below a car), the target appears below the road.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>

namespace boresight::simulator::radar {

inline constexpr double kWavelength_m = 299'792'458.0 / 77e9;

/// Effect of the ground on a one-way path.
struct GroundEffect {
  double gain_db = 0.0;        ///< of power, one way
  double elevation_rad = 0.0;  ///< apparent elevation of the arriving wave
};

/// Magnitude of the amplitude reflection coefficient of asphalt with a roughness of 1.5 mm. It falls with the grazing
/// angle by Rayleigh's roughness criterion.
[[nodiscard]] inline double ground_reflection(double sine_of_grazing) {
  constexpr double kSmooth = 0.4, kRoughness_m = 0.0015;
  const double phase = 2.0 * M_PI * kRoughness_m * sine_of_grazing / kWavelength_m;
  return kSmooth * std::exp(-2.0 * phase * phase);
}

/// Two-ray interference between a sensor and a target at these heights and this horizontal distance.
[[nodiscard]] inline GroundEffect two_rays(double distance_m, double sensor_m, double target_m) {
  const double direct = std::hypot(distance_m, target_m - sensor_m);
  const double ground = std::hypot(distance_m, target_m + sensor_m);
  const double upper = std::atan2(target_m - sensor_m, distance_m),
               lower = -std::atan2(target_m + sensor_m, distance_m);
  const double magnitude = ground_reflection((target_m + sensor_m) / ground) * direct / ground;
  // The reflection at grazing incidence turns the phase by π.
  const std::complex<double> ground_ray = -std::polar(magnitude, -2.0 * M_PI * (ground - direct) / kWavelength_m);
  const std::complex<double> sum = 1.0 + ground_ray;
  // Two unresolved sources appear at the real part of their weighted mean direction (glint), which may lie outside the
  // interval between them.
  const double weight = std::clamp((ground_ray / sum).real(), -1.0, 1.0);
  return {10.0 * std::log10(std::norm(sum)), upper + weight * (lower - upper)};
}

}  // namespace boresight::simulator::radar
