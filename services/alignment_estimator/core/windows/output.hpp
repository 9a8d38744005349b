// A radar's estimate from the solution over all windows.
#pragma once

#include <cstddef>

#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/windows/curve_sums.hpp"
#include "services/alignment_estimator/core/windows/solver.hpp"

namespace boresight::alignment::windows {

/// What a radar without elevation takes for the elevations of its reflectors.
struct Unmeasured {
  double lowering = 0.0;   ///< mean reduction of its range rates, relative
  double mean_sine = 0.0;  ///< of the elevation
};

/// Writes scale, rotation, their covariance, observability and the other parameters of the model. `load`: number of
/// load steps so far; the rotation is the mounting without them. State, reason, counts and events stay as they are.
void write_solution(const Solver& solver, std::size_t radar, double time_s, int load, const Knots& knots,
                    const Unmeasured& unmeasured, RadarEstimate& out);

}  // namespace boresight::alignment::windows
