// Creates the published methods.
#pragma once

#include <memory>

#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/published/config.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::published {

/// For the start of the program: it allocates. Radars in the order of the vehicle's list.
[[nodiscard]] std::unique_ptr<Method> make_published(Kind kind, const VehicleConfig& vehicle,
                                                     const PublishedConfig& config = {});

/// For Burza's simulation: the published constants, and no gate because it has no moving objects.
[[nodiscard]] inline PublishedConfig as_published() {
  PublishedConfig config;
  config.gate = false;
  return config;
}

}  // namespace boresight::alignment::published
