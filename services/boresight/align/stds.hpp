// What the covariance of an estimate says of its parameters.
#pragma once

#include <array>

#include "services/alignment_estimator/core/method.hpp"
#include "services/boresight/align/result.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::align {

/// Of k_v and of what a further turn about the vehicle's axes may be, as yaw, pitch, roll.
[[nodiscard]] std::array<double, kParameters> turn_stds(const alignment::RadarEstimate& estimate);

/// Of (k_v, yaw, pitch, roll) as the rotation vector d has them. The covariance is that of a turn e after it,
/// Exp(e)·Exp(d); where d is large and the roll little known, that moves the other two components of d as well:
/// Log(Exp(e)·Exp(d)) = d + J⁻¹(d)·e with J⁻¹ = I − [d]×/2 + [d]×²/12.
[[nodiscard]] std::array<double, kParameters> component_stds(const RadarConfig& config,
                                                             const alignment::RadarEstimate& estimate);

}  // namespace boresight::align
