// What one range rate of something tells of another one, from elsewhere.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

/// Density of `value` as q·v, of a velocity v of which one component is measured, e·v = rate: most go along the mirror
/// (rails and walls follow the road), the others anywhere.
[[nodiscard]] inline double rate_density(double value, const Eigen::Vector2d& q, const Eigen::Vector2d& e, double rate,
                                         double rate_variance, const Eigen::Vector2d& along, double variance) {
  constexpr double kSpeedAlong_mps = 20.0, kSpeedAcross_mps = 1.5, kSpeedAnyway_mps = 10.0;
  constexpr double kAlongShare = 0.75;
  const Eigen::Vector2d across(-along.y(), along.x());
  const auto given = [&](double var_along, double var_across) {
    const double qa = q.dot(along), qc = q.dot(across), ea = e.dot(along), ec = e.dot(across);
    const double qe = qa * ea * var_along + qc * ec * var_across;
    const double ee = ea * ea * var_along + ec * ec * var_across + rate_variance;
    const double qq = qa * qa * var_along + qc * qc * var_across;
    return gaussian(value - qe / ee * rate, std::max(0.0, qq - qe * qe / ee) + variance);
  };
  return kAlongShare * given(square(kSpeedAlong_mps), square(kSpeedAcross_mps)) +
         (1.0 - kAlongShare) * given(square(kSpeedAnyway_mps), square(kSpeedAnyway_mps));
}

}  // namespace boresight::ghosts
