// All values of a radar's estimate as one vector, to compare estimates and to widen their standard deviations.
#pragma once

#include <Eigen/Core>

#include "services/alignment_estimator/core/method.hpp"

namespace boresight::alignment::batch {

/// k_v; rotation about the vehicle's x, y and z axes; then all else that RadarEstimate has with a standard deviation.
inline constexpr int kMainValues = 4;
inline constexpr int kValues = kMainValues + 7 + static_cast<int>(kAzimuthCurveKnots) + 2 + 2;
using Values = Eigen::Matrix<double, kValues, 1>;

/// The rotation is that from `about`.
[[nodiscard]] Values values_of(const RadarEstimate& estimate, const Eigen::Matrix3d& about);
/// Zero where the estimate states none.
[[nodiscard]] Values stds_of(const RadarEstimate& estimate);
/// Widens the standard deviations to these where they are larger, at unchanged correlations. A parameter that is not
/// estimated stays so.
void widen(RadarEstimate& estimate, const Values& stds);
/// Largest difference of the main values in the standard deviations of `b`.
[[nodiscard]] double moved_stds(const RadarEstimate& a, const RadarEstimate& b);

}  // namespace boresight::alignment::batch
