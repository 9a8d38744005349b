#include "services/boresight/score/car_truth.hpp"

#include <string_view>

#include "interfaces/messages/header.hpp"
#include "services/boresight/score/table.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::score {

namespace {

double value_or(const std::map<std::uint32_t, double>& values, std::uint32_t radar, double otherwise) {
  const auto found = values.find(radar);
  return found == values.end() ? otherwise : found->second;
}

}  // namespace

double CarTruth::stamp_offset_s(std::uint32_t radar) const {
  return value_or(stamp_offsets_s, radar, 0.0);
}

Eigen::Matrix3d CarTruth::load_rotation(double t_s) const {
  return geometry::sensor_to_vehicle(0.0, load_pitch_at(t_s), 0.0);
}

CarTruth read_car_truth(const std::filesystem::path& file) {
  CarTruth car;
  if (file.empty()) return car;
  Table table(file, {"quantity", "radar", "value"});
  while (table.next()) {
    const std::string_view quantity = table.text("quantity");
    const auto radar = [&] { return static_cast<std::uint32_t>(table.integer("radar", 1, kMaxRadars)); };
    const auto angle = [&] { return table.number("value", -90.0, 90.0) * kRadiansPerDegree; };
    if (quantity == "load_pitch") car.load_pitch_rad = angle();
    if (quantity == "load_time") car.load_time_s = table.number("value", 0.0, 1e7);
    if (quantity == "side_slip_std") car.side_slip_std_rad = angle();
    if (quantity == "range_rate_scale") car.range_rate_scales[radar()] = table.number("value", 0.5, 2.0);
    // Later than the times that objects are kept for is no offset of a stamp.
    if (quantity == "stamp_offset") car.stamp_offsets_s[radar()] = table.number("value", -1.0, 1.0);
  }
  return car;
}

}  // namespace boresight::score
