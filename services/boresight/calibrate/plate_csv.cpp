#include "services/boresight/calibrate/plate_csv.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace boresight::calibrate {

namespace plate = alignment::plate;

plate::Measurements read_plate(recording::ByteSource& source, input::Problems& problems) {
  constexpr double kRadians = M_PI / 180.0;
  constexpr std::array<input::Column, 3> kColumns{
      {{"tilt_deg", -20.0, 20.0, "deg"}, {"amplitude_db", -200.0, 200.0, "dB"}, {"azimuth_deg", -90.0, 90.0, "deg"}}};
  input::CsvTable table(source, kColumns, problems);
  plate::Measurements run;
  double tilt_deg = NAN;
  std::array<double, kColumns.size()> row{};
  while (table.next(row)) {
    if (row[0] != tilt_deg) {
      if (run.number_of_tilts == plate::kMaxTilts) {
        table.reject(0, fmt::format("{:g} deg is tilt number {}; a run has at most {} tilts, each in consecutive rows",
                                    row[0], run.number_of_tilts + 1, plate::kMaxTilts));
        continue;
      }
      tilt_deg = row[0];
      run.tilts[run.number_of_tilts++].tilt_rad = tilt_deg * kRadians;
    }
    if (!run.tilts[run.number_of_tilts - 1].add(row[1], row[2] * kRadians)) {
      table.reject(0, fmt::format("more than {} scans at a tilt of {:g} deg", plate::kMaxScansPerTilt, tilt_deg));
      continue;
    }
    table.accept();
  }
  return run;
}

}  // namespace boresight::calibrate
