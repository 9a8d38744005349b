// The usable detections of one scan as columns of doubles, the input of every alignment method.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// The first `count` entries of each column are valid. Angles in the sensor frame (rad), range rate in m/s. All values
/// except the range are finite, all stds positive. Large: keep one per method, never on the stack.
struct ScanDetections {
  std::int64_t time_ns = 0;
  std::size_t count = 0;
  bool has_elevation = false;  ///< else elevation_rad is 0 and elevation_std_rad that of the configuration
  /// Width of the unambiguous interval of range rates; a measured range rate may be off by whole multiples of it. 0: no
  /// ambiguity known.
  double ambiguity_mps = 0.0;
  std::array<double, kMaxDetections> range_m;  ///< as sent, not checked
  std::array<double, kMaxDetections> azimuth_rad;
  std::array<double, kMaxDetections> elevation_rad;
  std::array<double, kMaxDetections> range_rate_mps;
  std::array<double, kMaxDetections> azimuth_std_rad;
  std::array<double, kMaxDetections> elevation_std_rad;
  std::array<double, kMaxDetections> range_rate_std_mps;
};

/// Copies the usable detections. Rejected are those that the sensor marks invalid, those with values that are not
/// finite, and those marked ambiguous unless the interval is known. Stds that the sensor does not state, or states as
/// not positive, are taken from `radar.noise`. No allocation.
void take_detections(const RadarScan& scan, const RadarConfig& radar, ScanDetections& out);

}  // namespace boresight::alignment
