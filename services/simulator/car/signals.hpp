// What the ego signals of a real car state.
#pragma once

#include <cmath>

#include "services/simulator/car/real_car.hpp"

namespace boresight::simulator::car {

/// The yaw-rate signal, without noise.
[[nodiscard]] inline double signalled_yaw_rate(const RealCar& car, double yaw_rate_radps) {
  if (car.yaw_rate_gain == 0.0 && car.yaw_rate_bias_radps == 0.0) return yaw_rate_radps;
  return (1.0 + car.yaw_rate_gain) * yaw_rate_radps + car.yaw_rate_bias_radps;
}

/// The speed signal in its steps; noise comes before.
[[nodiscard]] inline double quantised_speed(const RealCar& car, double speed_mps) {
  if (car.speed_step_mps <= 0.0) return speed_mps;
  return car.speed_step_mps * std::round(speed_mps / car.speed_step_mps);
}

}  // namespace boresight::simulator::car
