// False detections: clutter, and interference by another radar.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/radar/key.hpp"
#include "services/simulator/radar/round_trip.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator::radar {

/// Interference at an instant, summed over all transmitters.
struct Disturbance {
  double noise_rise_db = 0.0;
  double detections_per_scan = 0.0;
};

[[nodiscard]] inline Disturbance disturbance_at(const std::vector<RadarInterference>& interference, std::uint32_t radar,
                                                double t_s) {
  double noise = 1.0;
  Disturbance sum;
  for (const RadarInterference& i : interference) {
    if ((i.radar != 0 && i.radar != radar) || t_s < i.begin_s || t_s >= i.begin_s + i.duration_s) continue;
    noise += std::pow(10.0, 0.1 * i.noise_rise_db) - 1.0;
    sum.detections_per_scan += i.detections_per_scan;
  }
  sum.noise_rise_db = 10.0 * std::log10(std::max(1.0, noise));
  return sum;
}

/// Appends a Poisson-distributed number of echoes at random places of the field of view, just above the threshold,
/// since false detections are weak. Range rates are uniform within ±`rate_max_mps`.
inline void add_false(Stream& stream, double mean, double mean_excess_db, double threshold_db, double rate_max_mps,
                      const FieldOfView& view, Cause cause, std::vector<Echo>& echoes) {
  const unsigned count = stream.poisson(mean);
  for (unsigned i = 0; i < count; ++i) {
    Echo e{};
    e.range_m = stream.uniform(1.0, std::max(1.0, view.range_max_m));
    e.azimuth_rad = stream.uniform(view.azimuth_min_rad, view.azimuth_max_rad);
    e.elevation_rad = stream.uniform(view.elevation_min_rad, view.elevation_max_rad);
    e.range_rate_mps = stream.uniform(-rate_max_mps, rate_max_mps);
    e.power_db = threshold_db - mean_excess_db * std::log(1.0 - stream.uniform());
    e.truth.provenance = Provenance::kClutter;
    e.truth.cause = cause;
    e.key = key_of(i, stream.next());
    echoes.push_back(e);
  }
}

}  // namespace boresight::simulator::radar
