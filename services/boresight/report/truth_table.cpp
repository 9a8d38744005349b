#include "services/boresight/report/truth_table.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <istream>
#include <sstream>
#include <string>

namespace boresight::report {

Truth read_truth(std::istream& input) {
  constexpr double kRadians = 3.14159265358979323846 / 180.0;
  Truth truth;
  for (std::string line; std::getline(input, line);) {
    std::istringstream columns(line);
    std::array<std::string, 3> cells;  // quantity, radar, value
    for (std::string& cell : cells) std::getline(columns, cell, ',');
    char* end = nullptr;
    const double value = std::strtod(cells[2].c_str(), &end);
    if (end == cells[2].c_str() || !std::isfinite(value)) continue;
    if (cells[0] == "speed_scale") truth.speed_scale = value;
    const auto radar = static_cast<std::uint32_t>(std::strtoul(cells[1].c_str(), nullptr, 10));
    if (cells[0] == "alignment_yaw") truth.yaw_rad[radar] = value * kRadians;
    if (cells[0] == "scans" && value >= 0.0) truth.scans[radar] = static_cast<std::uint64_t>(value);
  }
  return truth;
}

}  // namespace boresight::report
