// Azimuth of the plate: yaw error, Burza 2025, §7 (9).
#pragma once

#include "services/alignment_estimator/core/plate/fit.hpp"

namespace boresight::alignment::plate {

/// Fills yaw, its std and azimuth_inlier_ratio; result.tilts[i].used must be known. False if at most half of the tilts
/// agree with one another; the yaw is then that of all tilts.
[[nodiscard]] bool find_azimuth(const Measurements& measurements, FitMethod method, PlateResult& result);

}  // namespace boresight::alignment::plate
