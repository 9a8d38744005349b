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

/// Elevations may be wrong by as much as they scatter for as long as the scene is the same, over many segments:
/// variance of pitch (rad²) beside that of the solution. What was known before the drive is not from them.
[[nodiscard]] double lasting_pitch_variance(const Priors& priors, const RadarSolution& radar);

/// Writes scale, rotation, their covariance, observability and the other parameters of the model. `load`: number of
/// load steps so far; the rotation is the mounting without them. `linearised`: rotation at which the derivatives were
/// taken and the solution's differences are vectors. State, reason, counts and events stay as they are.
void write_solution(const Solver& solver, std::size_t radar, double time_s, int load, const Knots& knots,
                    const Eigen::Matrix3d& linearised, const Unmeasured& unmeasured, RadarEstimate& out);

}  // namespace boresight::alignment::windows
