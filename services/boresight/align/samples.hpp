// All estimates at one time, as the series of a result holds them.
#pragma once

#include <vector>

#include "services/alignment_estimator/core/write_estimate.hpp"
#include "services/boresight/align/result.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::align {

[[nodiscard]] inline std::array<double, kParameters> to_array(const Eigen::Vector4d& v) {
  return {v(0), v(1), v(2), v(3)};
}

/// One estimate for each radar of the vehicle, in its order.
[[nodiscard]] Sample sample_of(const VehicleConfig& vehicle, double time_s,
                               const std::vector<alignment::RadarEstimate>& estimates);

}  // namespace boresight::align
