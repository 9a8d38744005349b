// What truth.csv states about a real car: effects that a judge must take into account.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>

#include <Eigen/Core>

namespace boresight::score {

/// Effects that the table does not state are off.
struct CarTruth {
  double load_pitch_rad = 0.0;  ///< of the body by load, positive with the nose up
  double load_time_s = 0.0;     ///< from this time of the drive on
  double side_slip_std_rad = 0.0;
  std::map<std::uint32_t, double> range_rate_scales;  ///< measured / true range rate, by radar; see DriveTruth
  std::map<std::uint32_t, double> stamp_offsets_s;    ///< stamp − measurement, by radar

  [[nodiscard]] double stamp_offset_s(std::uint32_t radar) const;
  /// Rotation of the body by the load at a time of the drive, in the axes of the unloaded vehicle.
  [[nodiscard]] Eigen::Matrix3d load_rotation(double t_s) const;
  [[nodiscard]] double load_pitch_at(double t_s) const { return t_s >= load_time_s ? load_pitch_rad : 0.0; }
};

/// Throws InputError for a value out of its range. An empty path is a car without effects.
[[nodiscard]] CarTruth read_car_truth(const std::filesystem::path& file);

}  // namespace boresight::score
