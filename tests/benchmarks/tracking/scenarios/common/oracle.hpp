// The oracle: the association of every measurement is known, and the tracker's own single-object component is filtered
// for each object alone. No tracker with this component can be expected to be better.
#pragma once

#include "tests/benchmarks/tracking/scenarios/common/scenario.hpp"

namespace boresight::bench::scenarios {

/// Estimates of the objects that exist with a probability above one half. The existence of an object is filtered with
/// the model, from its first detection on: 1 with a detection, less by survival and P_D without one; the end of an
/// object is not known.
[[nodiscard]] track::ObjectsByStep oracle_estimates(const Scenario& scenario, const Measurements& measurements);

}  // namespace boresight::bench::scenarios
