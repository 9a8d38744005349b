// Creates a method by its name.
#pragma once

#include <memory>

#include "services/alignment_estimator/core/config.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// Throws std::invalid_argument for an unknown name.
[[nodiscard]] std::unique_ptr<Method> make_method(const VehicleConfig& vehicle, const Config& config);

}  // namespace boresight::alignment
