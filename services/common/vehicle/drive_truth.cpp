#include "services/common/vehicle/drive_truth.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <istream>
#include <sstream>
#include <string>

#include "interfaces/messages/header.hpp"

namespace boresight {

double DriveTruth::speed_scale_seen_by(std::uint32_t radar) const {
  const auto found = radars.find(radar);
  return speed_scale_seen(speed_scale, found == radars.end() ? 1.0 : found->second.range_rate_scale);
}

DriveTruth read_drive_truth(std::istream& input) {
  constexpr double kRadians = M_PI / 180.0;
  constexpr double kMostScans = 9007199254740992.0;  // 2^53: a count is exact in a double up to here
  DriveTruth truth;
  for (std::string line; std::getline(input, line);) {
    std::istringstream columns(line);
    std::array<std::string, 3> cells;  // quantity, radar, value
    for (std::string& cell : cells) std::getline(columns, cell, ',');
    char* end = nullptr;
    const double value = std::strtod(cells[2].c_str(), &end);
    if (end == cells[2].c_str() || !std::isfinite(value)) continue;
    if (cells[0] == "speed_scale") truth.speed_scale = value;
    const unsigned long id = std::strtoul(cells[1].c_str(), nullptr, 10);
    if (id < 1 || id > kMaxRadars) continue;
    const auto radar = [&]() -> DriveTruth::Radar& { return truth.radars[static_cast<std::uint32_t>(id)]; };
    if (cells[0] == "alignment_yaw") radar().yaw_rad = value * kRadians;
    if (cells[0] == "alignment_pitch") radar().pitch_rad = value * kRadians;
    if (cells[0] == "alignment_roll") radar().roll_rad = value * kRadians;
    if (cells[0] == "range_rate_scale") radar().range_rate_scale = value;
    if (cells[0] == "scans" && value >= 0.0 && value <= kMostScans) radar().scans = static_cast<std::uint64_t>(value);
  }
  return truth;
}

}  // namespace boresight
