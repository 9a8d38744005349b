// Samples received by DDS, as lines for people or for programs.
#pragma once

#include <cstdint>
#include <string>

#include "generated/diagnostic_array.h"
#include "generated/sensor_health.h"
#include "generated/system_health.h"
#include "services/health/dds/presence.hpp"

namespace boresight::diagnostics_text {

/// "12:34:56.7 front_right  AVAILABLE_REDUCED MISALIGNED  yaw +2.490 ± 0.021° (reduced, beyond 1.50°)  …"
[[nodiscard]] std::string to_line(const diagnostics::SensorHealth& sensor);
/// A line with line feed: config/schema/json.md.
[[nodiscard]] std::string to_json(const diagnostics::SensorHealth& sensor);
/// "12:34:56.7 system  AVAILABLE_REDUCED  pipeline AVAILABLE_REDUCED  12 scans lost  …"
[[nodiscard]] std::string to_line(const diagnostics::SystemHealth& system);
/// A line with line feed: config/schema/json.md.
[[nodiscard]] std::string to_json(const diagnostics::SystemHealth& system);
/// One line for each status that is not OK, or one line that all are OK.
[[nodiscard]] std::string to_lines(const diagnostic_msgs::msg::dds_::DiagnosticArray_& array);
[[nodiscard]] std::string to_json(const diagnostic_msgs::msg::dds_::DiagnosticArray_& array);

/// "12:34:56.7 front_right  STALE since 1.6 s: no sample within the deadline, the health service is silent", or that it
/// is received again. `time_ns`: now, since the epoch.
[[nodiscard]] std::string to_line(const dds::Presence& presence, std::int64_t time_ns);
/// A line with line feed: config/schema/json.md.
[[nodiscard]] std::string to_json(const dds::Presence& presence, std::int64_t time_ns);

}  // namespace boresight::diagnostics_text
