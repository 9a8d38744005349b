// Prediction of a square root through a linear motion: one half of the fast square-root filters (Liang and Guo 2016).
// Equations: docs/algorithms/tracking.md (T29).
#pragma once

#include "services/tracker/core/filters/gaussian.hpp"

namespace boresight::tracking::filters {

template <typename Real, int N>
[[nodiscard]] bool has_positive_diagonal(const Matrix<Real, N, N>& root) {
  return root.diagonal().minCoeff() > Real(0) && root.diagonal().allFinite();
}

/// By the QR decomposition of [F S, root of Q]ᵀ: square roots throughout.
template <typename Real, int N, typename Motion>
[[nodiscard]] bool predict_root_by_qr(RootGaussian<Real, N>& state, const Motion& motion) {
  motion.move(state.mean);
  motion.move_columns(state.root);
  Matrix<Real, 2 * N, N> rows;
  for (int k = 0; k < N; ++k) {
    for (int j = 0; j < N; ++j) rows(j, k) = state.root(k, j);
    for (int j = 0; j < N; ++j) rows(N + j, k) = motion.noise().root(k, j);
  }
  qr_root(rows, state.root);
  return has_positive_diagonal(state.root) && state.mean.allFinite();
}

/// The same by two small QR decompositions. S is lower triangular and each axis has its own noise, so half of
/// [F S, root of Q]ᵀ is zero: the first axis needs the first three columns of S, the second what they leave.
template <typename Real, typename Motion>
[[nodiscard]] bool predict_root_by_axes(RootGaussian<Real, 6>& state, const Motion& motion) {
  motion.move(state.mean);
  motion.move_columns(state.root);
  const Matrix<Real, 6, 6>& noise = motion.noise().root;
  Matrix<Real, 6, 6> first;
  Matrix<Real, 9, 3> second;
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 6; ++k) first(j, k) = state.root(k, j);
    for (int k = 0; k < 3; ++k) {
      first(3 + j, k) = noise(k, j);
      first(3 + j, 3 + k) = Real(0);
      second(3 + j, k) = state.root(3 + k, 3 + j);
      second(6 + j, k) = noise(3 + k, 3 + j);
    }
  }
  reflect_columns<3>(first);
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k) second(j, k) = first(3 + j, 3 + k);
  }
  reflect_columns<3>(second);
  for (int j = 0; j < 3; ++j) {
    const Real first_sign = first(j, j) < Real(0) ? Real(-1) : Real(1);
    const Real second_sign = second(j, j) < Real(0) ? Real(-1) : Real(1);
    for (int k = 0; k < 6; ++k) state.root(k, j) = k < j ? Real(0) : first_sign * first(j, k);
    for (int k = 0; k < 3; ++k) {
      state.root(k, 3 + j) = Real(0);
      state.root(3 + k, 3 + j) = k < j ? Real(0) : second_sign * second(j, k);
    }
  }
  return has_positive_diagonal(state.root) && state.mean.allFinite();
}

/// By the Cholesky root of F S Sᵀ Fᵀ + Q: quicker, with a covariance in between. F S is lower triangular but for the
/// blocks of 3 × 3 of the axes, since S is and F is block diagonal.
template <typename Real, int N, typename Motion>
[[nodiscard]] bool predict_root_by_cholesky(RootGaussian<Real, N>& state, const Motion& motion) {
  static_assert(N % 3 == 0);
  motion.move(state.mean);
  motion.move_columns(state.root);
  const Matrix<Real, N, N>& moved = state.root;
  Matrix<Real, N, N> covariance;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j <= i; ++j) {
      Real sum = motion.noise().covariance(i, j);
      const int columns = (j / 3 + 1) * 3;
      for (int k = 0; k < columns; ++k) sum += moved(i, k) * moved(j, k);
      covariance(i, j) = sum;
    }
  }
  return cholesky(covariance, state.root) && state.mean.allFinite();
}

}  // namespace boresight::tracking::filters
