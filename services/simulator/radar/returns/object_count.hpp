// Number of detections of an object that is detected.
#pragma once

#include <algorithm>
#include <cstdint>

#include "services/simulator/radar/returns/draws.hpp"
#include "services/simulator/radar/returns/interpolate.hpp"
#include "services/simulator/radar/returns/object_class.hpp"

namespace boresight::simulator::radar {

[[nodiscard]] inline double mean_count(const CountSpec& spec, ObjectClass c, double range_m, double aspect_rad) {
  using S = CountSpec;
  const double mean = interpolated(spec.range_m,
                                   entry_of<S, ByRange>(c, spec, &S::car, &S::truck, &S::two_wheeler, &S::pedestrian,
                                                        &S::standing_vehicle, &S::standing_truck),
                                   range_m);
  const bool person = c == ObjectClass::kTwoWheeler || c == ObjectClass::kPedestrian;
  return person ? mean : mean * by_aspect(aspect_rad, spec.rear_factor, spec.side_factor, spec.front_factor);
}

/// 1 + Poisson with that mean, at most `most`.
[[nodiscard]] inline unsigned count_of(const CountSpec& spec, double mean, std::uint32_t object, const Draws& draws) {
  const double further = std::max(0.0, mean - 1.0);
  return std::min(spec.most, 1 + poisson_at(draws.held("count", object, spec.correlation).uniform(), further));
}

}  // namespace boresight::simulator::radar
