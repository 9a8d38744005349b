// Where the plate was seen: yaw error, Burza 2025, §7 (9).
#pragma once

#include "services/alignment_estimator/core/plate/fit.hpp"

namespace boresight::alignment::plate {

/// Fills yaw, its std and azimuth_inlier_ratio; result.tilts[i].used must be known. False if no more than half of the
/// tilts agree with one another; the yaw is then that of all of them.
[[nodiscard]] bool find_azimuth(const Measurements& measurements, FitMethod method, PlateResult& result);

}  // namespace boresight::alignment::plate
