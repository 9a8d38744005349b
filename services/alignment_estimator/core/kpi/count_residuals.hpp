// The residuals of one scan: which detections stand still by today's estimate, and how well it explains them.
#pragma once

#include <span>

#include "services/alignment_estimator/core/kpi/residual_statistics.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// `predicted`: Method::predict of the scan (m/s). A residual is an inlier's within `gate_sigma` stds: of the range
/// rate, of the angles by way of the model, of the ego signals. Both residuals are wrapped into the unambiguous
/// interval, where one is known. No allocation.
void count_residuals(const RadarConfig& radar, const RadarEstimate& estimate, const ScanDetections& scan,
                     const EgoSample& ego, std::span<const double> predicted, double gate_sigma,
                     ResidualStatistics& statistics);

}  // namespace boresight::alignment
