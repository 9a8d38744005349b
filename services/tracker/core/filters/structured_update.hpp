// Update of a square root by a polar measurement, with the sigma points that move it. Columns 0 to 3 of the
// lower-triangular root change the place, column 4 changes only v_y, and column 5 only a_y, which is not measured. So
// 8 points and one straight term replace 13 points, with the same result. Equations: docs/algorithms/tracking.md (T30).
#pragma once

#include <algorithm>
#include <cmath>

#include "services/tracker/core/filters/flat_arctangent.hpp"
#include "services/tracker/core/filters/gain.hpp"
#include "services/tracker/core/filters/noise.hpp"
#include "services/tracker/core/filters/polar_measurement.hpp"
#include "services/tracker/core/filters/sigma_points.hpp"

namespace boresight::tracking::filters {

/// How the root of the innovation's covariance is made.
enum class InnovationRoot { kByQr, kByCholesky };

/// The measurement at the mean, and its deviations at the moving points.
template <typename Real, int M>
struct MovingPoints {
  Vector<Real, M> centre;
  Matrix<Real, 8, M> deviations;  ///< rows 0 … 3: forward along columns 0 … 3, rows 4 … 7: back
  Real velocity_term = Real(0);   ///< range rate along column 4; the way back is its negative
  Vector<Real, M> offset;         ///< mean of all points
};

template <typename Real, int M>
[[nodiscard]] MovingPoints<Real, M> moving_points(const RootGaussian<Real, 6>& state, const SigmaPoints<Real, 6>& sigma,
                                                  const PolarMeasurement<Real, M>& measurement) {
  const Real x = state.mean(0) - measurement.sensor_m.x(), y = state.mean(3) - measurement.sensor_m.y();
  const Real v_x = state.mean(1), v_y = state.mean(4);
  const Real range_m = std::sqrt(x * x + y * y), inverse_range = Real(1) / range_m;
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
  points.centre(0) = range_m;
  points.centre(1) = flat_arctangent(y, x);
  if constexpr (M == 3) points.centre(2) = range_rate;
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
  // The outer points of columns 4 and 5 and the middle one deviate by −d, but for ±l in the range rate: together
  // (4 w + w_0) d dᵀ, and 2 w l² beside the noise of the range rate. Rows: 8 points, d, and the noise.
  const Real offset_weight = Real(4) * sigma.weight + sigma.centre_weight;
  const Real factor = std::sqrt(sigma.weight), offset_factor = std::sqrt(std::max(offset_weight, Real(0)));
  Matrix<Real, 9 + M, M> rows;
  for (int k = 0; k < M; ++k) {
    for (int i = 0; i < 8; ++i) rows(i, k) = factor * (points.deviations(i, k) - points.offset(k));
    rows(8, k) = offset_factor * points.offset(k);
    for (int j = 0; j < M; ++j) rows(9 + j, k) = noise.root(k, j);
  }
  if constexpr (M == 3) {
    const Real straight = factor * points.velocity_term;
    rows(11, 2) = std::sqrt(rows(11, 2) * rows(11, 2) + Real(2) * straight * straight);
  }
  qr_root(rows, root);
  return offset_weight >= Real(0) || rank_one_update<Real, M>(root, points.offset, offset_weight);
}

/// False if a root is not that of a positive definite covariance, or a value is not finite; `state` must not be used
/// then.
template <InnovationRoot How, typename Real, int M>
[[nodiscard]] bool update_root_by_moving_points(RootGaussian<Real, 6>& state, const SigmaPoints<Real, 6>& sigma,
                                                const PolarMeasurement<Real, M>& measurement,
                                                const Vector<Real, M>& value, const Noise<Real, M>& noise) {
  const MovingPoints<Real, M> points = moving_points(state, sigma, measurement);
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
  Vector<Real, M> innovation = measurement.innovation(value, points.centre) - points.offset;
  innovation(1) = wrapped(innovation(1));
  return apply_gain<Real, 6, M>(state, root, cross, innovation);
}

}  // namespace boresight::tracking::filters
