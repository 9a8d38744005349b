// The part of a health report that is about the whole system, as DDS type.
#pragma once

#include <cstdint>
#include <string>

#include "generated/system_health.h"
#include "interfaces/messages/health_report.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::dds {

/// `time_ns` is since the epoch.
[[nodiscard]] diagnostics::SystemHealth to_system_health(const HealthReport& report, const VehicleConfig& vehicle,
                                                         std::int64_t time_ns);

/// Trouble codes of the failed tests of the pipeline, separated by blanks; empty without a failure.
[[nodiscard]] std::string pipeline_trouble_codes(const PipelineHealth& pipeline);

}  // namespace boresight::dds
