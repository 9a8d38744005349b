// Scenarios with road users of all classes at random places, for training: general, and unlike any shipped scenario.
#pragma once

#include <cstdint>

#include "services/simulator/scenario.hpp"

namespace boresight::fit_classes {

/// Classes are equally frequent. Each road user is near the ego vehicle at some time, drives along the road, against
/// it or across, and has a size and a speed of its class. Every fourth vehicle is slow. The same seed gives the same
/// scenario.
[[nodiscard]] simulator::Scenario random_traffic(std::uint64_t seed, double duration_s);

}  // namespace boresight::fit_classes
