// Scans and ego motions → bodies of the Boresight service's events (interfaces/wire/boresight_service.md, 3 and 4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"

namespace boresight::replay {

/// Time of measurement of the content on the sender's clock.
struct SensorTime {
  std::int64_t epoch_ns = 0;  ///< since 1970; negative values and those after 2106 are sent as 0
  std::uint8_t sync_status = 1;
};

/// Writes the body and returns its length; 0 if `out` is too short for it. A value that the service does not allow,
/// including NaN, is sent as 0 and its detection flagged invalid; a standard deviation is then sent as not stated. A
/// scan has at most 1024 detections.
[[nodiscard]] std::size_t write_detection_list(const RadarScan& scan, const SensorTime& time,
                                               std::span<std::uint8_t> out);

/// The same for ego motion; a value that is not allowed is sent as not stated.
[[nodiscard]] std::size_t write_ego_motion(const EgoMotion& ego, const SensorTime& time, std::span<std::uint8_t> out);

}  // namespace boresight::replay
