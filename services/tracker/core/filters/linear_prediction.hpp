// Prediction of a square root through a linear motion: one half of the fast square-root filters (Liang and Guo 2016).
// Equations: docs/algorithms/tracking.md (T29).
#pragma once

#include "services/tracker/core/filters/gaussian.hpp"

namespace boresight::tracking::filters {

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
  for (int k = 0; k < N; ++k) {
    if (!(state.root(k, k) > Real(0))) return false;
  }
  return state.mean.allFinite();
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
