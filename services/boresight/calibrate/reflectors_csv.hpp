// Reads a table of reflector positions, surveyed and measured.
#pragma once

#include <string>
#include <vector>

#include "services/alignment_estimator/core/reflectors/reflectors.hpp"
#include "services/boresight/input/csv_table.hpp"

namespace boresight::calibrate {

struct ReflectorTable {
  std::vector<alignment::reflectors::Position> positions;
  std::vector<std::uint64_t> lines;  ///< of each position's first row in the file
  bool has_elevation = false;
};

/// Columns x_m, y_m, z_m (surveyed, vehicle frame; ±100 m), range_m (0…100), azimuth_deg (±90) and, where the radar
/// measures it, elevation_deg (±90), both in the sensor frame. Several rows of one surveyed position (scans of it) are
/// replaced by their medians. If any row lacks the elevation, the radar counts as one without elevation.
[[nodiscard]] ReflectorTable read_reflectors(recording::ByteSource& source, input::Problems& problems);

}  // namespace boresight::calibrate
