// A service's heartbeat and the verdict on it as DDS type.
#pragma once

#include <cstdint>
#include <string>

#include "generated/service_status.h"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/service_status.hpp"

namespace boresight::dds {

/// Replaces the content of `out`. `status`: the latest heartbeat, null without one. `time_ns` is since the epoch.
void fill(diagnostics::ServiceStatus& out, const ServiceHealth& health, const ServiceStatus* status,
          const std::string& vehicle_name, std::int64_t time_ns);

}  // namespace boresight::dds
