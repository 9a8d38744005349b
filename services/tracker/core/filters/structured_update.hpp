// Update of a square root by a polar measurement, with the sigma points that move it. Columns 0 to 3 of the
// lower-triangular root change the place, column 4 changes only v_y, and column 5 only a_y, which is not measured. So
// 8 points and one straight term replace 13 points, with the same result. Equations: docs/algorithms/tracking.md (T30).
#pragma once

#include "services/tracker/core/filters/flat_arctangent.hpp"
#include "services/tracker/core/filters/gain.hpp"
#include "services/tracker/core/filters/noise.hpp"
#include "services/tracker/core/filters/polar_measurement.hpp"
#include "services/tracker/core/filters/sigma_points.hpp"

namespace boresight::tracking::filters {

/// How the root of the innovation's covariance is made.
enum class InnovationRoot { kByQr, kByCholesky };

/// Deviations of the measurement at the moving points from the one at the mean.
template <typename Real, int M>
struct MovingPoints {
  Matrix<Real, 8, M> deviations;  ///< rows 0 … 3: forward along columns 0 … 3, rows 4 … 7: back
  Real velocity_term = Real(0);   ///< range rate along column 4; the way back is its negative
  Vector<Real, M> offset;         ///< mean of all points
};

template <typename Real, int M>
[[nodiscard]] MovingPoints<Real, M> moving_points(const RootGaussian<Real, 6>& state, const SigmaPoints<Real, 6>& sigma,
                                                  const PolarMeasurement<Real, M>& measurement, Real range_m) {
  const Real x = state.mean(0) - measurement.sensor_m.x(), y = state.mean(3) - measurement.sensor_m.y();
  const Real v_x = state.mean(1), v_y = state.mean(4), inverse_range = Real(1) / range_m;
  Vector<Real, 8> point_x, point_y, point_v_x, point_v_y;
  for (int j = 0; j < 4; ++j) {
    const Real dx = sigma.spread * state.root(0, j), dy = sigma.spread * state.root(3, j);
    const Real dv_x = sigma.spread * state.root(1, j), dv_y = sigma.spread * state.root(4, j);
    point_x(j) = x + dx;
    point_x(j + 4) = x - dx;
    point_y(j) = y + dy;
    point_y(j + 4) = y - dy;
    point_v_x(j) = v_x + dv_x;
    point_v_x(j + 4) = v_x - dv_x;
    point_v_y(j) = v_y + dv_y;
    point_v_y(j + 4) = v_y - dv_y;
  }
  MovingPoints<Real, M> points;
  const Real range_rate = (x * v_x + y * v_y) * inverse_range;
  for (int i = 0; i < 8; ++i) {
    const Real range = std::sqrt(point_x(i) * point_x(i) + point_y(i) * point_y(i));
    points.deviations(i, 0) = range - range_m;
    points.deviations(i, 1) = flat_arctangent(x * point_y(i) - y * point_x(i), x * point_x(i) + y * point_y(i));
    if constexpr (M == 3) {
      points.deviations(i, 2) = (point_x(i) * point_v_x(i) + point_y(i) * point_v_y(i)) / range - range_rate;
    }
  }
  for (int k = 0; k < M; ++k) {
    Real sum = Real(0);
    for (int i = 0; i < 8; ++i) sum += points.deviations(i, k);
    points.offset(k) = sum * sigma.weight;
  }
  if constexpr (M == 3) points.velocity_term = sigma.spread * state.root(4, 4) * y * inverse_range;
  return points;
}

template <typename Real, int M>
[[nodiscard]] bool innovation_root_by_cholesky(const MovingPoints<Real, M>& points, const SigmaPoints<Real, 6>& sigma,
                                               const Noise<Real, M>& noise, Matrix<Real, M, M>& root) {
  // Σ w (e − d)(e − d)ᵀ = Σ w e eᵀ − (2 − Σ w) d dᵀ over the 12 outer points, and the middle one deviates by −d.
  const Real factor = sigma.centre_weight + Real(12) * sigma.weight - Real(2);
  Matrix<Real, M, M> square;
  for (int k = 0; k < M; ++k) {
    for (int j = 0; j <= k; ++j) {
      Real sum = Real(0);
      for (int i = 0; i < 8; ++i) sum += points.deviations(i, k) * points.deviations(i, j);
      if (j == 2) sum += Real(2) * points.velocity_term * points.velocity_term;
      square(k, j) = sigma.weight * sum + factor * points.offset(k) * points.offset(j) + noise.covariance(k, j);
    }
  }
  return cholesky(square, root);
}

template <typename Real, int M>
[[nodiscard]] bool innovation_root_by_qr(const MovingPoints<Real, M>& points, const SigmaPoints<Real, 6>& sigma,
                                         const Noise<Real, M>& noise, Matrix<Real, M, M>& root) {
  // Rows: 8 points, both of column 4, both of column 5 as one, and the noise.
  Matrix<Real, 11 + M, M> rows;
  const Real factor = std::sqrt(sigma.weight), factor_of_two = std::sqrt(Real(2) * sigma.weight);
  for (int k = 0; k < M; ++k) {
    const Real straight = k == 2 ? points.velocity_term : Real(0);
    for (int i = 0; i < 8; ++i) rows(i, k) = factor * (points.deviations(i, k) - points.offset(k));
    rows(8, k) = factor * (straight - points.offset(k));
    rows(9, k) = factor * (-straight - points.offset(k));
    rows(10, k) = -factor_of_two * points.offset(k);
    for (int j = 0; j < M; ++j) rows(11 + j, k) = noise.root(k, j);
  }
  qr_root(rows, root);
  return rank_one_update<Real, M>(root, -points.offset, sigma.centre_weight);
}

/// False if a root is not that of a positive definite covariance, or a value is not finite; `state` must not be used
/// then.
template <InnovationRoot How, typename Real, int M>
[[nodiscard]] bool update_root_by_moving_points(RootGaussian<Real, 6>& state, const SigmaPoints<Real, 6>& sigma,
                                                const PolarMeasurement<Real, M>& measurement,
                                                const Vector<Real, M>& value, const Noise<Real, M>& noise) {
  const Vector<Real, M> centre = measurement.expected(state.mean);
  const MovingPoints<Real, M> points = moving_points(state, sigma, measurement, centre(0));
  const Real factor = sigma.weight * sigma.spread;
  Matrix<Real, 6, M> cross;
  for (int k = 0; k < M; ++k) {
    Vector<Real, 4> between;
    for (int j = 0; j < 4; ++j) between(j) = points.deviations(j, k) - points.deviations(j + 4, k);
    for (int i = 0; i < 6; ++i) {
      Real sum = Real(0);
      for (int j = 0; j < 4; ++j) sum += state.root(i, j) * between(j);
      cross(i, k) = factor * sum;
    }
  }
  if constexpr (M == 3) {
    for (int i = 4; i < 6; ++i) cross(i, 2) += factor * state.root(i, 4) * Real(2) * points.velocity_term;
  }
  Matrix<Real, M, M> root;
  const bool has_root = How == InnovationRoot::kByCholesky ? innovation_root_by_cholesky(points, sigma, noise, root)
                                                           : innovation_root_by_qr(points, sigma, noise, root);
  if (!has_root) return false;
  Vector<Real, M> innovation = measurement.innovation(value, centre) - points.offset;
  innovation(1) = wrapped(innovation(1));
  return apply_gain<Real, 6, M>(state, root, cross, innovation);
}

}  // namespace boresight::tracking::filters
