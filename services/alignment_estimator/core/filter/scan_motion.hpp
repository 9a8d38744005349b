// Signalled motion of the vehicle at the time of a scan.
#pragma once

namespace boresight::alignment {

/// The accelerations are those of the signals.
struct ScanMotion3d {
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double acceleration_mps2 = 0.0;
  double yaw_acceleration_radps2 = 0.0;
};

}  // namespace boresight::alignment
