// Sigma points of the scaled unscented transformation (van der Merwe and Wan 2001). Equations:
// docs/algorithms/tracking.md (T25).
#pragma once

#include <cmath>

#include "services/tracker/core/filters/gaussian.hpp"

namespace boresight::tracking::filters {

/// With α = 1 single precision suffices; with small α the weights cancel, and it does not.
struct SigmaPointParameters {
  double alpha = 1.0;  ///< spread of the points, as a factor
  double beta = 2.0;   ///< 2: best for a normal distribution
  double kappa = 0.0;  ///< second parameter of the spread

  [[nodiscard]] bool is_valid(int state_size) const {
    return std::isfinite(alpha * alpha * (state_size + kappa)) && alpha * alpha * (state_size + kappa) > 0.0 &&
           std::isfinite(beta);
  }
};

template <typename Real, int N>
struct SigmaPoints {
  using Points = Matrix<Real, N, 2 * N + 1>;  ///< the first column is the mean

  Real spread;         ///< distance of a point in columns of the root
  Real weight;         ///< of each point but the first, for means and covariances
  Real centre_weight;  ///< of the first point, for covariances

  explicit SigmaPoints(const SigmaPointParameters& parameters) {
    const double scale = parameters.alpha * parameters.alpha * (N + parameters.kappa);
    spread = static_cast<Real>(std::sqrt(scale));
    weight = static_cast<Real>(0.5 / scale);
    centre_weight =
        static_cast<Real>((scale - N) / scale + 1.0 - parameters.alpha * parameters.alpha + parameters.beta);
  }

  [[nodiscard]] Points of(const Vector<Real, N>& mean, const Matrix<Real, N, N>& root) const {
    Points points;
    for (int i = 0; i < N; ++i) {
      points(i, 0) = mean(i);
      for (int j = 0; j < N; ++j) {
        const Real step = spread * root(i, j);
        points(i, 1 + j) = mean(i) + step;
        points(i, 1 + N + j) = mean(i) - step;
      }
    }
    return points;
  }
};

}  // namespace boresight::tracking::filters
