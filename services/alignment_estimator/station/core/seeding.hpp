// The plate's result becomes what the dynamic estimator starts from.
#pragma once

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/alignment_estimator/core/plate/seed.hpp"

namespace boresight::alignment::station {

/// False, and nothing changes, if the estimator's method remembers nothing or has no room for the radar. What it knows
/// of the other radars and of the vehicle stays.
[[nodiscard]] bool seed_estimator(const RotationSeed& seed, Estimator& estimator);

}  // namespace boresight::alignment::station
