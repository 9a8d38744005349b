// A health report as DDS types.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "generated/diagnostic_array.h"
#include "generated/sensor_health.h"
#include "interfaces/messages/health_report.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::dds {

/// The radar at `index` of the report. `time_ns` is since the epoch: readers off the ECU do not know its monotonic
/// clock.
[[nodiscard]] diagnostics::SensorHealth to_sensor_health(const HealthReport& report, std::size_t index,
                                                         const VehicleConfig& vehicle, std::int64_t time_ns);

/// One status for the pipeline, one for each radar and one for each service; OK, WARN or ERROR by effect.
[[nodiscard]] diagnostic_msgs::msg::dds_::DiagnosticArray_ to_diagnostic_array(const HealthReport& report,
                                                                               const VehicleConfig& vehicle,
                                                                               std::int64_t time_ns);

}  // namespace boresight::dds
