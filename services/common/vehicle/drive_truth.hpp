// True values of a simulated drive: the truth.csv that `boresight simulate` writes beside its recordings.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <limits>
#include <map>
#include <optional>

namespace boresight {

/// Values that a table does not state are NaN or absent.
struct DriveTruth {
  struct Radar {
    /// Actual − nominal mounting, angle by angle: geometry::sensor_to_vehicle(nominal, yaw, pitch, roll).
    double yaw_rad = std::numeric_limits<double>::quiet_NaN();
    double pitch_rad = std::numeric_limits<double>::quiet_NaN();
    double roll_rad = std::numeric_limits<double>::quiet_NaN();
    std::optional<std::uint64_t> scans;  ///< number of scans that the radar sent
  };
  double speed_scale = std::numeric_limits<double>::quiet_NaN();  ///< k_v
  std::map<std::uint32_t, Radar> radars;                          ///< by id

  [[nodiscard]] bool known() const { return !radars.empty(); }
};

/// Lines "quantity,radar,value,unit" with quantities speed_scale, alignment_yaw, alignment_pitch, alignment_roll (deg)
/// and scans; other quantities are ignored. Values that are not numbers are skipped, so the result may be empty.
[[nodiscard]] DriveTruth read_drive_truth(std::istream& input);

}  // namespace boresight
