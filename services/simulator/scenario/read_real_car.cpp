#include "services/simulator/scenario/read_real_car.hpp"

#include "services/common/geometry/angles.hpp"

namespace boresight::simulator {

car::RealCar read_real_car(config::Reader reader) {
  car::RealCar c =
      reader.choice<car::RealCar>("preset", {{"none", {}}, {"real_car", car::real_car_preset()}}, car::RealCar{});
  c.range_rate_scale = reader.number("range_rate_scale", {0.0, 0.05}, c.range_rate_scale);
  c.azimuth_curve_rms_rad = reader.angle_deg("azimuth_curve_rms_deg", {0.0, 5.0}, c.azimuth_curve_rms_rad);
  c.position_error_m = reader.number("position_error_m", {0.0, 1.0}, c.position_error_m);
  c.stamp_offset_s = reader.number("stamp_offset_s", {0.0, 0.5}, c.stamp_offset_s);
  c.side_slip_std_rad = reader.angle_deg("side_slip_std_deg", {0.0, 5.0}, c.side_slip_std_rad);
  c.side_slip_correlation_s = reader.number("side_slip_correlation_s", {1.0, 1000.0}, c.side_slip_correlation_s);
  c.slip_coefficient_radps2pm = reader.number("slip_coefficient_radps2pm", {-0.05, 0.05}, c.slip_coefficient_radps2pm);
  c.load_pitch_rad = reader.angle_deg("load_pitch_deg", {-5.0, 5.0}, c.load_pitch_rad);
  c.load_time_s = reader.number("load_time_s", {0.0, 36000.0}, c.load_time_s);
  c.yaw_rate_gain = reader.number("yaw_rate_gain", {-0.2, 0.2}, c.yaw_rate_gain);
  c.yaw_rate_bias_radps = kRadiansPerDegree * reader.number("yaw_rate_bias_degps", {-10.0, 10.0},
                                                            c.yaw_rate_bias_radps * kDegreesPerRadian);
  c.speed_step_mps = reader.number("speed_step_mps", {0.0, 2.0}, c.speed_step_mps);
  c.road_mirror_share = reader.number("road_mirror_share", {0.0, 1.0}, c.road_mirror_share);
  return c;
}

}  // namespace boresight::simulator
