// Random measurements of a scenario's truth.
#pragma once

#include <cstdint>

#include "tests/benchmarks/tracking/scenarios/common/scenario.hpp"

namespace boresight::bench::scenarios {

/// New measurements by the scenario's model: objects are detected with P_D, the number of their detections is Poisson,
/// each detection ~ N(centre, spread · X + noise), clutter is uniform over the area. With range rates if the model has
/// a standard deviation for them. The order within a scan is random.
[[nodiscard]] Measurements draw_measurements(const Scenario& scenario, std::uint64_t seed);

/// Adds simulated range rates, seen from the origin: uᵀv and noise for an object's detections, uniform over the span
/// for clutter.
void add_range_rates(const Scenario& scenario, std::uint64_t seed, Measurements& measurements);

/// The origin of each measurement, drawn from its probabilities given the truth: with these, added range rates have the
/// distribution that they would have had in the recording.
void draw_origins(const Scenario& scenario, std::uint64_t seed, Measurements& measurements);

}  // namespace boresight::bench::scenarios
