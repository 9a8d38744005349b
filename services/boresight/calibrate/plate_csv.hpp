// Reads the table of a run of the tilting plate.
#pragma once

#include "services/alignment_estimator/core/plate/measurement.hpp"
#include "services/boresight/input/csv_table.hpp"

namespace boresight::calibrate {

/// Columns tilt_deg (−20…20, positive = toward the ground), amplitude_db (−200…200) and azimuth_deg (−90…90, sensor
/// frame, + left), a row for each scan; other columns are ignored. Consecutive rows of the same tilt belong together.
/// Rows that cannot be used are reported to `problems` and skipped; throws input::TableError as CsvTable does.
[[nodiscard]] alignment::plate::Measurements read_plate(recording::ByteSource& source, input::Problems& problems);

}  // namespace boresight::calibrate
