// The batch calibration over a whole recording; its result has the form of the methods that work scan by scan.
#pragma once

#include <vector>

#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"
#include "services/boresight/align/residuals.hpp"
#include "services/boresight/align/result.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::align {

/// Fills k_v, the radars' estimates and messages, which parameters the data support, and the iterations as series.
/// `result` has the radars of the vehicle file in its order, `samples` their detections. Takes seconds, so `progress`
/// is called in between.
void solve_batch_calibration(const VehicleConfig& vehicle, const std::vector<const ResidualSample*>& samples,
                             const alignment::batch_calibration::Config& settings,
                             const alignment::batch_calibration::Progress& progress, Result& result);

}  // namespace boresight::align
