// Azimuth ambiguity of the antenna array: a strong stationary reflector appears a second time at another azimuth.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "services/simulator/radar/returns/place.hpp"
#include "services/simulator/radar/returns/strength.hpp"

namespace boresight::simulator::radar {

/// sin(azimuth) of the copy: a step away, to the side where it stays in view.
[[nodiscard]] inline double ambiguous_sine(double sine, double step, double limit) {
  const double outward = std::copysign(step, sine);
  return std::abs(sine + outward) < limit ? sine + outward : sine - outward;
}

/// Appends copies of stationary detections, `per_scan` of them in the mean. A parent's chance grows with the root of
/// its power, so strong parents are preferred.
inline void add_ambiguous_azimuths(const AzimuthAmbiguitySpec& spec, const Draws& draws, const FieldOfView& fov,
                                   const StrengthSpec& strength, std::vector<Echo>& echoes) {
  constexpr std::uint64_t kCopy = 0xA21B;
  const StreamSeed effect = draws.of("azimuth");
  const auto is_parent = [](const Echo& e) { return e.truth.provenance == Provenance::kStationary; };
  const std::size_t parents = echoes.size();
  std::vector<double> weights(parents);
  double sum = 0.0;
  for (std::size_t i = 0; i < parents; ++i) {
    weights[i] = is_parent(echoes[i]) ? std::exp(0.05 * std::log(10.0) * rcs_of(echoes[i], fov)) : 0.0;
    sum += weights[i];
  }
  const double limit = std::sin(std::min(0.5 * M_PI, std::min(-fov.azimuth_min_rad, fov.azimuth_max_rad)));
  for (std::size_t i = 0; i < parents; ++i) {
    if (!is_parent(echoes[i])) continue;
    Stream stream = draws.once(effect, echoes[i].key);
    if (stream.uniform() * sum >= spec.per_scan * weights[i]) continue;
    const double step = spec.sine_step + spec.sine_step_std * stream.gaussian();
    const double sine = ambiguous_sine(std::sin(echoes[i].azimuth_rad), step, limit);
    if (std::abs(sine) >= limit) continue;
    Echo e = echoes[i];
    const double rcs = strength.on ? false_rcs(strength, e.range_m, stream) : rcs_of(e, fov);
    e.azimuth_rad = std::asin(sine);
    set_rcs(e, rcs, fov);
    e.truth.provenance = Provenance::kClutter;
    e.truth.cause = Cause::kAzimuthAmbiguity;
    e.key = key_of(kCopy, e.key);
    echoes.push_back(e);
  }
}

}  // namespace boresight::simulator::radar
