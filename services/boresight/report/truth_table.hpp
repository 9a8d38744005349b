// The truth of a simulated drive in the quantities of the estimates.
#pragma once

#include "services/boresight/report/summary.hpp"
#include "services/common/vehicle/drive_truth.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::report {

/// Radars that are not in the vehicle file have no angles about the vehicle's axes. Values that the drive does not
/// state are missing, so the result may be empty (`known()` is false).
[[nodiscard]] Truth truth_of(const DriveTruth& drive, const VehicleConfig& vehicle);

}  // namespace boresight::report
