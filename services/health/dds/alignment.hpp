// An alignment estimate as DDS type.
#pragma once

#include <cstdint>

#include "generated/alignment_estimate.h"
#include "generated/sensor_health.h"
#include "interfaces/messages/alignment_estimate.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::dds {

/// Replaces the content of `out`. `time_ns` is since the epoch.
void fill(diagnostics::AlignmentEstimate& out, const AlignmentEstimate& estimate, const VehicleConfig& vehicle,
          std::int64_t time_ns);

[[nodiscard]] diagnostics::MountingDrift to_drift(const AlignmentDrift& drift);
[[nodiscard]] diagnostics::VehicleChange to_change(const AlignmentVehicleChange& change);

}  // namespace boresight::dds
