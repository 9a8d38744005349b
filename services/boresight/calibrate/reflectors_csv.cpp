#include "services/boresight/calibrate/reflectors_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/common/estimation/median.hpp"

namespace boresight::calibrate {

namespace {

/// All rows of one reflector.
struct Rows {
  Eigen::Vector3d surveyed_m;
  std::uint64_t line = 0;
  std::vector<double> range_m, azimuth_rad, elevation_rad;
};

}  // namespace

ReflectorTable read_reflectors(recording::ByteSource& source, input::Problems& problems) {
  constexpr double kRadians = M_PI / 180.0;
  constexpr std::array<input::Column, 6> kColumns{{{"x_m", -100.0, 100.0, "m"},
                                                   {"y_m", -100.0, 100.0, "m"},
                                                   {"z_m", -100.0, 100.0, "m"},
                                                   {"range_m", 0.0, 100.0, "m"},
                                                   {"azimuth_deg", -90.0, 90.0, "deg"},
                                                   {"elevation_deg", -90.0, 90.0, "deg", false, true}}};
  input::CsvTable table(source, kColumns, problems);
  ReflectorTable result;
  std::vector<Rows> reflectors;
  std::array<double, kColumns.size()> row{};
  result.has_elevation = table.has(5);
  while (table.next(row)) {
    const Eigen::Vector3d surveyed(row[0], row[1], row[2]);
    auto found = std::find_if(reflectors.begin(), reflectors.end(),
                              [&](const Rows& rows) { return rows.surveyed_m == surveyed; });
    if (found == reflectors.end()) {
      found = reflectors.insert(found, {surveyed, table.line_number(), {}, {}, {}});
    }
    found->range_m.push_back(row[3]);
    found->azimuth_rad.push_back(row[4] * kRadians);
    found->elevation_rad.push_back(row[5] * kRadians);
    result.has_elevation = result.has_elevation && !std::isnan(row[5]);
    table.accept();
  }
  for (Rows& rows : reflectors) {
    alignment::reflectors::Position position;
    position.surveyed_m = rows.surveyed_m;
    position.range_m = estimation::median(rows.range_m);
    position.azimuth_rad = estimation::median(rows.azimuth_rad);
    if (result.has_elevation) position.elevation_rad = estimation::median(rows.elevation_rad);
    position.scans = rows.range_m.size();
    result.positions.push_back(position);
    result.lines.push_back(rows.line);
  }
  return result;
}

}  // namespace boresight::calibrate
