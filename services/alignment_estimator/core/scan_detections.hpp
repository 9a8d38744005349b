// The usable detections of one scan in the form that every alignment method reads: columns of doubles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// The first `count` entries of each column count. Angles in the sensor frame (rad), range rate in m/s; all finite,
/// stds positive, but for the range. Large: keep one a method, never on the stack.
struct ScanDetections {
  std::int64_t time_ns = 0;
  std::size_t count = 0;
  bool has_elevation = false;  ///< else elevation_rad is 0 and elevation_std_rad that of the configuration
  /// Width of the unambiguous interval of range rates: a measured one may be off by any whole multiple of it; 0: no
  /// ambiguity known.
  double ambiguity_mps = 0.0;
  std::array<double, kMaxDetections> range_m;  ///< may be anything that was sent
  std::array<double, kMaxDetections> azimuth_rad;
  std::array<double, kMaxDetections> elevation_rad;
  std::array<double, kMaxDetections> range_rate_mps;
  std::array<double, kMaxDetections> azimuth_std_rad;
  std::array<double, kMaxDetections> elevation_std_rad;
  std::array<double, kMaxDetections> range_rate_std_mps;
};

/// Takes over what can be used: leaves out what the sensor marks invalid and what is not finite; stds that the sensor
/// does not state, or states as not positive, are those of `radar.noise`. Detections marked ambiguous are left out
/// unless the interval is known. No allocation.
void take_detections(const RadarScan& scan, const RadarConfig& radar, ScanDetections& out);

}  // namespace boresight::alignment
