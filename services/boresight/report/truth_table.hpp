// The truth of a simulated drive in the terms in which estimates are shown.
#pragma once

#include "services/boresight/report/summary.hpp"
#include "services/common/vehicle/drive_truth.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::report {

/// Radars that the vehicle does not know have no angles about its axes. What is not stated is left out, so the result
/// may be empty (`known()` is false).
[[nodiscard]] Truth truth_of(const DriveTruth& drive, const VehicleConfig& vehicle);

}  // namespace boresight::report
