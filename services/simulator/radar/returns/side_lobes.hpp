// Azimuth side lobes of moving objects, and bursts of azimuth smear.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "services/simulator/radar/returns/place.hpp"
#include "services/simulator/radar/returns/strength.hpp"

namespace boresight::simulator::radar {

/// Appends side lobes of one object: the range and range rate of its strongest detection at another azimuth.
inline void add_side_lobes(const SideLobeSpec& spec, const Echo& strongest, const Draws& draws, const FieldOfView& fov,
                           std::vector<Echo>& echoes) {
  constexpr std::uint64_t kLobe = 0x10BE;
  Stream stream = draws.once("side lobe", strongest.truth.object_id);
  const unsigned count = stream.poisson(spec.per_object);
  for (unsigned i = 0; i < count; ++i) {
    Echo e = strongest;
    e.azimuth_rad = stream.uniform(fov.azimuth_min_rad, fov.azimuth_max_rad);
    const double rcs = rcs_of(strongest, fov) + spec.strength_db + spec.strength_std_db * stream.gaussian();
    if (std::abs(e.azimuth_rad - strongest.azimuth_rad) < spec.least_offset_rad) continue;
    set_rcs(e, rcs, fov);
    e.truth.provenance = Provenance::kClutter;
    e.truth.cause = Cause::kSideLobe;
    e.key = key_of(kLobe, key_of(strongest.truth.object_id, i));
    echoes.push_back(e);
  }
}

/// A burst: for seconds, many azimuths at one range interval show an echo with nearly zero range rate.
struct Burst {
  double begin_s, end_s;
  double range_m;  ///< of the interval's beginning
  double azimuth_min_rad, azimuth_max_rad;
};

/// The burst that begins in the `window`-th interval of `every_s`. Each window has one, at a random time in it.
[[nodiscard]] inline Burst burst_of(const BurstSpec& spec, std::uint64_t window, const Draws& draws,
                                    const FieldOfView& fov) {
  Stream stream = draws.always("burst", window);
  Burst b{};
  b.begin_s = (static_cast<double>(window) + stream.uniform()) * spec.every_s;
  b.end_s = b.begin_s + stream.uniform(spec.duration_min_s, spec.duration_max_s);
  b.range_m = stream.uniform(spec.range_min_m, spec.range_max_m);
  const double width =
      std::min(stream.uniform(1.0 / 3.0, 1.0) * spec.azimuth_width_rad, fov.azimuth_max_rad - fov.azimuth_min_rad);
  b.azimuth_min_rad = stream.uniform(fov.azimuth_min_rad, fov.azimuth_max_rad - width);
  b.azimuth_max_rad = b.azimuth_min_rad + width;
  return b;
}

/// Appends the detections of the bursts at that time.
inline void add_bursts(const BurstSpec& spec, double t_s, const Draws& draws, const FieldOfView& fov,
                       const StrengthSpec& strength, std::vector<Echo>& echoes) {
  constexpr std::uint64_t kBurst = 0xB0257;
  const auto now = static_cast<std::uint64_t>(std::max(0.0, t_s / spec.every_s));
  for (std::uint64_t window = now == 0 ? 0 : now - 1; window <= now; ++window) {
    const Burst burst = burst_of(spec, window, draws, fov);
    if (t_s < burst.begin_s || t_s >= burst.end_s) continue;
    Stream stream = draws.once("burst", window);
    const unsigned count = stream.poisson(spec.per_scan);
    for (unsigned i = 0; i < count; ++i) {
      Echo e{};
      e.range_m = burst.range_m + spec.depth_m * stream.uniform();
      e.azimuth_rad = stream.uniform(burst.azimuth_min_rad, burst.azimuth_max_rad);
      e.elevation_rad = stream.uniform(fov.elevation_min_rad, fov.elevation_max_rad);
      e.range_rate_mps = spec.range_rate_std_mps * stream.gaussian();
      const double rcs = false_rcs(strength, e.range_m, stream);
      if (e.range_m > fov.range_max_m) continue;
      set_rcs(e, rcs, fov);
      e.truth.provenance = Provenance::kClutter;
      e.truth.cause = Cause::kBurst;
      e.key = key_of(kBurst, key_of(draws.cycle, key_of(window, i)));
      echoes.push_back(e);
    }
  }
}

}  // namespace boresight::simulator::radar
