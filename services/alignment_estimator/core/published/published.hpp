// The published methods by name.
#pragma once

#include <memory>

#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/published/config.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::published {

/// For the start of the program: allocates. Radars in the order of the vehicle's list.
[[nodiscard]] std::unique_ptr<Method> make_published(Kind kind, const VehicleConfig& vehicle,
                                                     const PublishedConfig& config = {});

/// Burza's simulation: the constants as published and, since nothing moves in it, no gate.
[[nodiscard]] inline PublishedConfig as_published() {
  PublishedConfig config;
  config.gate = false;
  return config;
}

}  // namespace boresight::alignment::published
