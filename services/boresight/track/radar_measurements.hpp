// Measurements of one object by one radar: a table with a row for each step.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

namespace boresight::track {

/// State [x, v_x, a_x, y, v_y, a_y] in m, m/s and m/s².
using ObjectState = Eigen::Matrix<double, 6, 1>;

struct RadarMeasurement {
  std::int64_t step = 0;
  double range_m = 0.0, azimuth_rad = 0.0;
  double range_rate_mps = 0.0;  ///< over ground
};

struct RadarMeasurements {
  std::vector<RadarMeasurement> rows;  ///< steps increase
  std::vector<ObjectState> truth;      ///< of each row; empty: not known
};

/// Reads the columns k, range, azimuth_rad, radial_speed and, optionally, the true state tx, tvx, tax, ty, tvy, tay.
/// Other columns are ignored. Throws score::InputError, which names file, line, column and the allowed values.
[[nodiscard]] RadarMeasurements read_radar_measurements(const std::filesystem::path& file);

}  // namespace boresight::track
