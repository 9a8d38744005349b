// Staggered Doppler ambiguity: now and then the sensor resolves a range rate wrongly, by another width in each scan.
#pragma once

#include <cmath>
#include <vector>

#include "services/simulator/radar/returns/draws.hpp"
#include "services/simulator/radar/returns/place.hpp"

namespace boresight::simulator::radar {

/// Shifts a share of the direct detections towards the other side of zero. A scan has two widths, since the sensor
/// staggers its repetition rate. A shifted moving detection stays moving; a stationary one becomes clutter.
inline void shift_range_rates(const DopplerAmbiguitySpec& spec, const Draws& draws, std::vector<Echo>& echoes) {
  Stream widths = draws.once("ambiguity width");
  const double first = widths.uniform(spec.width_min_mps, spec.width_max_mps);
  const double second = widths.uniform(spec.width_min_mps, spec.width_max_mps);
  const StreamSeed effect = draws.of("doppler");
  for (Echo& e : echoes) {
    if (!is_direct(e)) continue;
    const bool moving = e.truth.provenance == Provenance::kMoving;
    Stream stream = draws.once(effect, e.key);
    if (stream.uniform() >= (moving ? spec.moving_share : spec.stationary_share)) continue;
    e.range_rate_mps -= std::copysign(stream.uniform() < 0.5 ? first : second, e.range_rate_mps);
    e.truth.cause = Cause::kDopplerAmbiguity;
    if (!moving) e.truth.provenance = Provenance::kClutter;
  }
}

}  // namespace boresight::simulator::radar
