#include "services/simulator/car/real_car.hpp"

#include "services/common/geometry/angles.hpp"

namespace boresight::simulator::car {

RealCar real_car_preset() {
  RealCar car;
  // Measured on recordings of two drives with four 77 GHz radars.
  car.range_rate_scale = 0.0025;
  car.azimuth_curve_rms_rad = 0.25 * kRadiansPerDegree;
  car.side_slip_std_rad = 0.1 * kRadiansPerDegree;
  car.slip_coefficient_radps2pm = 0.0045;
  // Plausible: tolerances of assembly, of radars' clocks and of CAN signals.
  car.position_error_m = 0.05;
  car.stamp_offset_s = 0.02;
  car.load_pitch_rad = 0.5 * kRadiansPerDegree;
  car.yaw_rate_gain = 0.01;
  car.yaw_rate_bias_radps = 0.1 * kRadiansPerDegree;
  car.speed_step_mps = 0.028;  // 0.1 km/h
  car.road_mirror_share = 0.1;
  return car;
}

}  // namespace boresight::simulator::car
