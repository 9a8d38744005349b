// Robust location of the scans of each tilt.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "services/alignment_estimator/core/plate/measurement.hpp"
#include "services/common/estimation/median.hpp"

namespace boresight::alignment::plate {

using Column = std::array<double, kMaxTilts>;

/// Robust location of a tilt's scans.
struct Location {
  double value = 0.0;
  double scan_variance = 0.0;  ///< of one scan: `scans` times that of the value
};

/// Tukey's biweight about the median, c = 4.685 σ by the MAD. It is as robust against bad scans as the median and
/// nearly as efficient as the mean on good ones; this efficiency helps to distinguish two bad tilts from good ones.
/// `all` are the same samples; their std is used if most samples are equal and the MAD is 0.
inline Location biweight(const std::array<double, kMaxScansPerTilt>& samples, const Welford& all, double smallest_std) {
  const std::size_t count = all.count();
  std::array<double, kMaxScansPerTilt> scratch = samples;
  double centre = estimation::median({scratch.data(), count});
  const double mad = estimation::mad_std({scratch.data(), count}, centre);
  const double scale = mad > smallest_std ? mad : std::max(std::sqrt(all.variance()), smallest_std);
  constexpr double kTukey = 4.685;
  Location result;
  for (int round = 0; round < 3; ++round) {
    double weights = 0.0, shift = 0.0, squares = 0.0, slope = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const double u = (samples[k] - centre) / (kTukey * scale);
      if (std::abs(u) >= 1.0) continue;
      const double w = (1.0 - u * u) * (1.0 - u * u);
      weights += w;
      shift += w * (samples[k] - centre);
      squares += w * w * (samples[k] - centre) * (samples[k] - centre);
      slope += (1.0 - u * u) * (1.0 - 5.0 * u * u);
    }
    centre += shift / weights;  // more than half of the samples are within one MAD of the median: never 0
    result = {centre, static_cast<double>(count) * squares / (slope * slope)};
  }
  return result;
}

/// Locations of all tilts with a std from the scatter of their scans. The noise of the radar is the same at every tilt,
/// so the usual scatter is a lower limit: a tilt with a small scatter by chance does not dominate the fit. A much
/// larger scatter is used as it is.
struct Locations {
  Column value{}, std{};
};

/// `get` gives a tilt's samples and their Welford as a pair of references.
template <typename Get>
[[nodiscard]] Locations locate(const Measurements& measurements, double smallest_std, Get get) {
  Locations result;
  Column scatter{}, scratch{};
  for (std::size_t i = 0; i < measurements.number_of_tilts; ++i) {
    const auto& [samples, all] = get(measurements.tilts[i]);
    const Location location = biweight(samples, all, smallest_std);
    result.value[i] = location.value;
    scatter[i] = scratch[i] = location.scan_variance;
  }
  const double usual =
      std::max(estimation::median({scratch.data(), measurements.number_of_tilts}), smallest_std * smallest_std);
  for (std::size_t i = 0; i < measurements.number_of_tilts; ++i) {
    const double of_scan = scatter[i] > 3.0 * usual ? scatter[i] : usual;
    result.std[i] = std::sqrt(of_scan / static_cast<double>(measurements.tilts[i].scans));
  }
  return result;
}

}  // namespace boresight::alignment::plate
