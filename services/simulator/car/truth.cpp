#include "services/simulator/car/truth.hpp"

#include "services/common/geometry/angles.hpp"

namespace boresight::simulator::car {

std::vector<TruthRow> truth_of_car(const RealCar& car) {
  std::vector<TruthRow> rows;
  const auto add = [&rows](bool is_on, const char* quantity, double value, const char* unit) {
    if (is_on) rows.push_back({quantity, std::nullopt, value, unit});
  };
  const bool slips = car.side_slip_std_rad != 0.0, is_loaded = car.load_pitch_rad != 0.0;
  add(slips, "side_slip_std", car.side_slip_std_rad * kDegreesPerRadian, "deg");
  add(slips, "side_slip_correlation", car.side_slip_correlation_s, "s");
  add(car.slip_coefficient_radps2pm != 0.0, "slip_coefficient", car.slip_coefficient_radps2pm, "rad/(m/s2)");
  add(is_loaded, "load_pitch", car.load_pitch_rad * kDegreesPerRadian, "deg");
  add(is_loaded, "load_time", car.load_time_s, "s");
  add(car.yaw_rate_gain != 0.0, "yaw_rate_gain", car.yaw_rate_gain, "1");
  add(car.yaw_rate_bias_radps != 0.0, "yaw_rate_bias", car.yaw_rate_bias_radps * kDegreesPerRadian, "deg/s");
  add(car.speed_step_mps != 0.0, "speed_step", car.speed_step_mps, "m/s");
  add(car.road_mirror_share != 0.0, "road_mirror_share", car.road_mirror_share, "1");
  return rows;
}

std::vector<TruthRow> truth_of_radar(const RealCar& car, const RadarOfCar& drawn, std::uint32_t radar) {
  std::vector<TruthRow> rows;
  if (car.range_rate_scale != 0.0) rows.push_back({"range_rate_scale", radar, drawn.range_rate_scale, "1"});
  if (car.azimuth_curve_rms_rad != 0.0) {
    rows.push_back({"azimuth_curve_rms", radar, drawn.curve.rms_rad * kDegreesPerRadian, "deg"});
    for (std::size_t i = 0; i < AzimuthCurve::kHarmonics; ++i) {
      const std::string number = std::to_string(i + 1);
      rows.push_back({"azimuth_curve_cos_" + number, radar, drawn.curve.cos_rad[i] * kDegreesPerRadian, "deg"});
      rows.push_back({"azimuth_curve_sin_" + number, radar, drawn.curve.sin_rad[i] * kDegreesPerRadian, "deg"});
    }
  }
  if (car.position_error_m != 0.0) {
    rows.push_back({"position_error_x", radar, drawn.position_error_m[0], "m"});
    rows.push_back({"position_error_y", radar, drawn.position_error_m[1], "m"});
  }
  if (car.stamp_offset_s != 0.0) rows.push_back({"stamp_offset", radar, drawn.stamp_offset_s, "s"});
  return rows;
}

}  // namespace boresight::simulator::car
