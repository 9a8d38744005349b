// Any text as the table of a real car's effects. It must be rejected with an error, or give effects within their
// ranges.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "services/simulator/scenario/read_real_car.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace boresight;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    config::Reader root = config::Reader::parse(text, "fuzz.toml");
    const simulator::car::RealCar car = simulator::read_real_car(root);
    root.finish();
    // The largest values that config/schema/scenario.md allows, in radians for angles.
    const auto is_within = [](double value, double min, double max) { return value >= min && value <= max; };
    constexpr double kDegrees5_rad = 0.0872665, kDegrees10_rad = 0.174533;
    fuzz::require(is_within(car.range_rate_scale, 0.0, 0.05) && is_within(car.position_error_m, 0.0, 1.0));
    fuzz::require(is_within(car.azimuth_curve_rms_rad, 0.0, kDegrees5_rad));
    fuzz::require(is_within(car.stamp_offset_s, 0.0, 0.5) && is_within(car.side_slip_std_rad, 0.0, kDegrees5_rad));
    fuzz::require(is_within(car.side_slip_correlation_s, 1.0, 1000.0));
    fuzz::require(is_within(car.slip_coefficient_radps2pm, -0.05, 0.05));
    fuzz::require(is_within(car.load_pitch_rad, -kDegrees5_rad, kDegrees5_rad));
    fuzz::require(is_within(car.load_time_s, 0.0, 36000.0) && is_within(car.yaw_rate_gain, -0.2, 0.2));
    fuzz::require(is_within(car.yaw_rate_bias_radps, -kDegrees10_rad, kDegrees10_rad));
    fuzz::require(is_within(car.speed_step_mps, 0.0, 2.0) && is_within(car.road_mirror_share, 0.0, 1.0));
  } catch (const config::Error&) {
  }
  return 0;
}
