// Detection of an echo: fluctuation of the cross section and probability of detection.
#pragma once

#include <algorithm>
#include <cmath>

#include "services/simulator/radar_effects.hpp"

namespace boresight::simulator::radar {

/// Signal-to-noise ratio (dB) at which half of the steady echoes are detected, at a false-alarm rate of 1e-6 per cell.
inline constexpr double kHalfDetected_db = 11.24;

/// Probability of detecting a steady echo in noise (North's approximation of Marcum's Q) at a false-alarm rate of 1e-6.
[[nodiscard]] inline double steady_detection_probability(double snr_db) {
  const double threshold = std::sqrt(6.0 * std::log(10.0));
  return 0.5 * std::erfc(threshold - std::sqrt(std::pow(10.0, 0.1 * snr_db) + 0.5));
}

/// The same for a power relative to 0 dBsm at 10 m, which is the scale of the scenario's threshold.
[[nodiscard]] inline double detection_probability(double power_db, const SensitivitySpec& spec) {
  return spec.max_probability * steady_detection_probability(power_db - spec.threshold_db + kHalfDetected_db);
}

/// Swerling's family of fluctuations: cross sections are χ²-distributed about their mean with 2k degrees of freedom
/// (k = 1: Swerling 1, no scatterer dominates; k = 2: Swerling 3, one scatterer dominates). Returns the k whose
/// standard deviation in dB is `std_db`. The smallest k is 1, which has 5.57 dB.
[[nodiscard]] inline double swerling_order(double std_db) {
  const double wanted = std::pow(std::max(0.1, std_db) * std::log(10.0) / 10.0, 2);
  // The variance of ln χ² is the trigamma function of k; three Newton steps on its asymptotic series from k = 1/σ².
  double k = std::max(1.0, 1.0 / wanted + 0.5);
  for (int i = 0; i < 3; ++i) {
    const double value = 1.0 / k + 0.5 / (k * k) + 1.0 / (6.0 * k * k * k);
    const double slope = -1.0 / (k * k) - 1.0 / (k * k * k) - 0.5 / (k * k * k * k);
    k = std::max(1.0, k - (value - wanted) / slope);
  }
  return k;
}

/// The cross section relative to its mean, dB, from one standard normal draw (Wilson and Hilferty's cube).
[[nodiscard]] inline double fluctuation_db(double order, double normal) {
  const double root = 1.0 - 1.0 / (9.0 * order) + normal / (3.0 * std::sqrt(order));
  return 30.0 * std::log10(std::max(0.05, root));
}

}  // namespace boresight::simulator::radar
