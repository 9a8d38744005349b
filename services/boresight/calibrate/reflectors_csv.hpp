// Reflector positions, surveyed and measured, as a table.
#pragma once

#include <string>
#include <vector>

#include "services/alignment_estimator/core/reflectors/reflectors.hpp"
#include "services/boresight/align/csv_table.hpp"

namespace boresight::calibrate {

struct ReflectorTable {
  std::vector<alignment::reflectors::Position> positions;
  std::vector<std::uint64_t> lines;  ///< of each position's first row in the file
  bool has_elevation = false;
};

/// Columns x_m, y_m, z_m (surveyed, vehicle frame; ±100 m), range_m (0…100), azimuth_deg (±90) and, where the radar
/// measures it, elevation_deg (±90), both in the sensor frame. Several rows of one surveyed position (scans of it)
/// become one, of their medians; an elevation that is missing in any row makes a radar without elevation.
[[nodiscard]] ReflectorTable read_reflectors(recording::ByteSource& source, align::Problems& problems);

}  // namespace boresight::calibrate
