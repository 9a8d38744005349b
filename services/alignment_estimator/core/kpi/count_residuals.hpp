// The residuals of one scan: which detections are stationary by the present estimate, and how well it fits them.
#pragma once

#include <span>

#include "services/alignment_estimator/core/kpi/residual_statistics.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// `predicted`: Method::predict of the scan (m/s). A detection is an inlier if its residual is within `gate_sigma`
/// stds. The std combines the range rate, the angles through the model, and the ego signals. Both residuals are wrapped
/// into the unambiguous interval, if it is known. No allocation.
void count_residuals(const RadarConfig& radar, const RadarEstimate& estimate, const ScanDetections& scan,
                     const EgoSample& ego, std::span<const double> predicted, double gate_sigma,
                     ResidualStatistics& statistics);

}  // namespace boresight::alignment
