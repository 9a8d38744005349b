// The road as a mirror: direct and ground path interfere, which fades targets by height and distance and moves their
// apparent elevation; where only the ground path gets through (below a car), the image below the road is seen.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>

namespace boresight::simulator::radar {

inline constexpr double kWavelength_m = 299'792'458.0 / 77e9;

/// What the ground does to a one-way path.
struct GroundEffect {
  double gain_db = 0.0;        ///< of power, one way
  double elevation_rad = 0.0;  ///< apparent, of the arriving wave
};

/// Amplitude reflection coefficient of rough asphalt, magnitude. It falls with the grazing angle as the surface's
/// roughness (1.5 mm) grows in wavelengths (Rayleigh's criterion).
[[nodiscard]] inline double ground_reflection(double sine_of_grazing) {
  constexpr double kSmooth = 0.4, kRoughness_m = 0.0015;
  const double phase = 2.0 * M_PI * kRoughness_m * sine_of_grazing / kWavelength_m;
  return kSmooth * std::exp(-2.0 * phase * phase);
}

/// Two-ray interference between a sensor and a target at these heights, `distance_m` apart in the plane.
[[nodiscard]] inline GroundEffect two_rays(double distance_m, double sensor_m, double target_m) {
  const double direct = std::hypot(distance_m, target_m - sensor_m);
  const double ground = std::hypot(distance_m, target_m + sensor_m);
  const double upper = std::atan2(target_m - sensor_m, distance_m),
               lower = -std::atan2(target_m + sensor_m, distance_m);
  const double magnitude = ground_reflection((target_m + sensor_m) / ground) * direct / ground;
  // The reflection at grazing incidence turns the phase by π.
  const std::complex<double> image = -std::polar(magnitude, -2.0 * M_PI * (ground - direct) / kWavelength_m);
  const std::complex<double> sum = 1.0 + image;
  // Two unresolved sources appear at the real part of their weighted mean direction (glint); it may lie outside both.
  const double weight = std::clamp((image / sum).real(), -1.0, 1.0);
  return {10.0 * std::log10(std::norm(sum)), upper + weight * (lower - upper)};
}

}  // namespace boresight::simulator::radar
