// How fast road users turn: few drivers exceed a lateral acceleration, and no vehicle turns in less than its radius.
#pragma once

#include <cmath>

namespace boresight::tracking {

struct TurnParameters {
  double lateral_acceleration_mps2 = 2.0;  ///< one standard deviation
  double radius_m = 6.0;                   ///< of the sharpest turn
  double time_s = 1.0;                     ///< how long a turn rate lasts
};

/// Standard deviation of the turn rate at a speed v: a v / (v² + a R), about v / R when slow and a / v when fast.
[[nodiscard]] inline double turn_rate_std_radps(const TurnParameters& p, double squared_speed_m2ps2) {
  return p.lateral_acceleration_mps2 * std::sqrt(squared_speed_m2ps2) /
         (squared_speed_m2ps2 + p.lateral_acceleration_mps2 * p.radius_m);
}

}  // namespace boresight::tracking
