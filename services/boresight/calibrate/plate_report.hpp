// The result of a plate's run as table, JSON and plot.
#pragma once

#include <optional>
#include <string>

#include "services/alignment_estimator/core/plate/fit.hpp"
#include "services/alignment_estimator/core/plate/seed.hpp"

namespace boresight::calibrate {

struct PlateRun {
  std::string tool_version;
  std::string source;  ///< the table's name
  alignment::plate::Measurements measurements;
  alignment::plate::FitConfig config;
  alignment::plate::PlateResult result;
  std::optional<alignment::RotationSeed> seed;  ///< if the radar's mounting is known
};

/// The tilts, the fit and the result, or the reason of the failure.
[[nodiscard]] std::string to_table(const PlateRun& run);
/// Angles in degrees; null for values that a failed run does not have. `seed` is in vehicle axes, its covariance
/// row-major.
[[nodiscard]] std::string to_json(const PlateRun& run);
/// Amplitude of every scan over the tilt, the amplitude that the fit used at each tilt, its parabola and the maximum
/// with ±2σ.
[[nodiscard]] std::string to_svg(const PlateRun& run);

}  // namespace boresight::calibrate
