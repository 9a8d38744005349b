// What was known when an event failed.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace boresight::health {

/// Values at an occurrence. Quantities that are not known, or do not belong to the event's subject, are NaN.
struct FreezeFrame {
  std::int64_t time_ns = 0;     ///< since the epoch; 0: no frame
  std::uint64_t uptime_ns = 0;  ///< CLOCK_MONOTONIC of the ECU
  std::uint32_t cycle = 0;      ///< operation cycle
  float speed_mps = 0.0F;       ///< signalled speed of the vehicle
  float rate_hz = 0.0F;         ///< scans of the radar
  float detections_per_scan = 0.0F;
  float lateral_displacement_m = 0.0F;  ///< consequence, at the reference range
  float reference_range_m = 0.0F;
  // Further consequences, as in SensorHealth:
  float lost_coverage_ratio = std::numeric_limits<float>::quiet_NaN();
  float range_loss_ratio = std::numeric_limits<float>::quiet_NaN();
  float velocity_error_mps = std::numeric_limits<float>::quiet_NaN();
  std::array<float, 4> estimate{};     ///< k_v, yaw, pitch, roll (rad), as AlignmentParameter
  std::array<float, 10> covariance{};  ///< of it: upper triangle, row by row
  std::uint64_t configuration = 0;     ///< fingerprint of the configuration files
  std::array<char, 16> software{};     ///< version, zero-terminated
};

}  // namespace boresight::health
