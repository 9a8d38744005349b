// Detections of a moving object whose range rate deviates from that of the rigid body.
#pragma once

#include <algorithm>
#include <cmath>

#include "services/simulator/radar/returns/interpolate.hpp"
#include "services/simulator/radar/returns/object_class.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator::radar {

struct MicroDoppler {
  double deviation_mps;
  bool deviates;  ///< by over 0.5 m/s
};

[[nodiscard]] inline double micro_doppler_share(const MicroDopplerSpec& spec, BodyKind kind, double aspect_rad) {
  if (kind == BodyKind::kPedestrian) return spec.pedestrian;
  if (kind == BodyKind::kCyclist) return spec.two_wheeler;
  return by_aspect(aspect_rad, spec.rear, spec.side, spec.front);
}

/// `radial_mps`: the body's radial velocity over ground, positive away. The ratio of a large deviation to it is drawn
/// by its quantiles: negative means slower than the body. A body that hardly moves along the line of sight has only
/// small deviations.
[[nodiscard]] inline MicroDoppler micro_doppler(const MicroDopplerSpec& spec, BodyKind kind, double aspect_rad,
                                                double radial_mps, Stream& stream) {
  constexpr double kSmall_mps = 0.5, kLarge_mps = 1.0;  // bounds of the measured shares
  if (stream.uniform() >= micro_doppler_share(spec, kind, aspect_rad)) {
    return {kind == BodyKind::kPedestrian ? spec.pedestrian_std_mps * stream.gaussian() : 0.0, false};
  }
  if (stream.uniform() >= spec.large_share) {
    const double sign = stream.uniform() < 0.5 ? -1.0 : 1.0;
    return {sign * stream.uniform(kSmall_mps, kLarge_mps), true};
  }
  const double deviation = value_at(stream.uniform(), kFrom5To95, spec.ratio, -1.0, 0.6) * radial_mps;
  if (std::abs(deviation) >= kLarge_mps) return {deviation, true};
  return {std::copysign(stream.uniform(kSmall_mps, kLarge_mps), deviation), true};
}

}  // namespace boresight::simulator::radar
