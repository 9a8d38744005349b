// What the body of a real car does: side slip of the rear axle, and pitch by load.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "services/simulator/car/real_car.hpp"

namespace boresight::simulator::car {

/// Side slip by crosswind and road camber (rad), positive to the left. It is a first-order Gauss–Markov process at
/// knots, ten to a correlation time, with a smooth step between two knots. It depends on the seed, not on the duration.
class SideSlip {
 public:
  SideSlip(const RealCar& car, std::uint64_t seed, double duration_s);

  /// `t_s` counts from the start of the drive; outside the drive the value is that at its nearer end.
  [[nodiscard]] double at(double t_s) const;

 private:
  double step_s_ = 1.0;
  std::vector<double> knots_rad_;  // none: no slip
};

/// Share of the side slip at a speed: it fades below walking and parking speeds, so that a vehicle at rest keeps its
/// heading. A choice.
[[nodiscard]] inline double side_slip_share(double speed_mps) {
  constexpr double kFullSlip_mps = 5.0;
  return std::min(1.0, std::abs(speed_mps) / kFullSlip_mps);
}

/// Side slip in a bend (rad) at a speed along the path and a turn rate of the path: outwards.
[[nodiscard]] inline double bend_slip_rad(double slip_coefficient_radps2pm, double speed_mps, double turn_rate_radps) {
  return -slip_coefficient_radps2pm * speed_mps * turn_rate_radps;
}

/// Pitch of the body by load, positive with the nose up.
[[nodiscard]] inline double load_pitch_rad(const RealCar& car, double t_s) {
  return t_s >= car.load_time_s ? car.load_pitch_rad : 0.0;
}

}  // namespace boresight::simulator::car
