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

/// One status for the whole, one for each radar and one for each service. AVAILABLE is OK, AVAILABLE_REDUCED is WARN.
/// ERROR is a proven fault. STALE is not known: a radar without data and without a proven fault, a service without
/// heartbeats, and the whole if that is all that makes it unusable.
[[nodiscard]] diagnostic_msgs::msg::dds_::DiagnosticArray_ to_diagnostic_array(const HealthReport& report,
                                                                               const VehicleConfig& vehicle,
                                                                               std::int64_t time_ns);

/// Makes of the last array the one that ends the topic: every status is STALE, because nobody updates it any more.
void to_ended(diagnostic_msgs::msg::dds_::DiagnosticArray_& array, std::int64_t time_ns);

}  // namespace boresight::dds
