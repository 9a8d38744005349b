// True values of a simulated drive: the truth.csv that `boresight simulate` writes beside its recordings.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <limits>
#include <map>
#include <optional>

namespace boresight {

/// The speed scale that an estimator sees through a radar: true speed / signalled speed (k_v) times measured / true
/// range rate of this radar, because both act on the same ratio.
[[nodiscard]] constexpr double speed_scale_seen(double speed_scale, double range_rate_scale) {
  return speed_scale * range_rate_scale;
}

/// Values that a table does not state are NaN or absent.
struct DriveTruth {
  struct Radar {
    /// Actual − nominal mounting, angle by angle: geometry::sensor_to_vehicle(nominal, yaw, pitch, roll).
    double yaw_rad = std::numeric_limits<double>::quiet_NaN();
    double pitch_rad = std::numeric_limits<double>::quiet_NaN();
    double roll_rad = std::numeric_limits<double>::quiet_NaN();
    std::optional<std::uint64_t> scans;  ///< number of scans that the radar sent
    double range_rate_scale = 1.0;       ///< measured / true range rate
  };
  double speed_scale = std::numeric_limits<double>::quiet_NaN();  ///< k_v
  std::map<std::uint32_t, Radar> radars;                          ///< by id

  [[nodiscard]] bool known() const { return !radars.empty(); }
  /// The speed scale that this radar sees; NaN if k_v is not stated.
  [[nodiscard]] double speed_scale_seen_by(std::uint32_t radar) const;
};

/// Lines "quantity,radar,value,unit" with quantities speed_scale, alignment_yaw, alignment_pitch, alignment_roll (deg),
/// range_rate_scale and scans; other quantities are ignored. Values that are not numbers are skipped, so the result may
/// be empty.
[[nodiscard]] DriveTruth read_drive_truth(std::istream& input);

}  // namespace boresight
