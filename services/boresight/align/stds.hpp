// Standard deviations of the parameters of an estimate.
#pragma once

#include <array>

#include "services/alignment_estimator/core/write_estimate.hpp"
#include "services/boresight/align/result.hpp"

namespace boresight::align {

/// Standard deviations of k_v and of yaw, pitch and roll about the vehicle's axes.
[[nodiscard]] std::array<double, kParameters> stds_of(const alignment::VehicleForm& form);

}  // namespace boresight::align
