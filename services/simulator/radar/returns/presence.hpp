// Whether a radar detects an object in sight at all: a two-state Markov chain per object and radar, so misses last.
#pragma once

#include <algorithm>
#include <cstdint>

#include "services/simulator/radar/returns/draws.hpp"
#include "services/simulator/radar/returns/interpolate.hpp"
#include "services/simulator/radar/returns/object_class.hpp"

namespace boresight::simulator::radar {

/// Correlation of the chain's states from scan to scan: P(none | none) = p + ρ·(1 − p) with p = P(none).
[[nodiscard]] inline double presence_correlation(double none, double none_after_none) {
  return std::clamp((none_after_none - none) / std::max(1e-6, 1.0 - none), 0.0, 1.0);
}

/// The chain as a uniform number that is held from scan to scan with probability ρ: the object is missed while the
/// number is below P(none). So P(none) may change with range, and no state is kept.
[[nodiscard]] inline bool is_present(const PresenceSpec& spec, ObjectClass c, double range_m, std::uint32_t object,
                                     const Draws& draws) {
  using S = PresenceSpec;
  const ByRange& by_range = entry_of<S, ByRange>(c, spec, &S::car, &S::truck, &S::two_wheeler, &S::pedestrian,
                                                 &S::standing_vehicle, &S::standing_truck);
  const double after_none =
      entry_of<S, double>(c, spec, &S::car_after_none, &S::truck_after_none, &S::two_wheeler_after_none,
                          &S::pedestrian_after_none, &S::standing_vehicle_after_none, &S::standing_truck_after_none);
  const double none = interpolated(spec.range_m, by_range, range_m);
  return draws.held("presence", object, presence_correlation(none, after_none)).uniform() >= none;
}

}  // namespace boresight::simulator::radar
