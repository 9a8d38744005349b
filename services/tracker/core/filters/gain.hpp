// The last step of a square-root update: gain by two triangular solutions, and the downdate of the root.
#pragma once

#include "services/tracker/core/filters/gaussian.hpp"

namespace boresight::tracking::filters {

/// Innovation with the root `innovation_root` of its covariance, and its cross-covariance with the state: (T28). False
/// if the root of the state would not be that of a positive definite covariance; `state` must not be used then.
template <typename Real, int N, int M>
[[nodiscard]] bool apply_gain(RootGaussian<Real, N>& state, const Matrix<Real, M, M>& innovation_root,
                              const Matrix<Real, N, M>& cross, const Vector<Real, M>& innovation) {
  Vector<Real, M> inverse, whitened;
  for (int j = 0; j < M; ++j) inverse(j) = Real(1) / innovation_root(j, j);
  Matrix<Real, N, M> gain;  // of the whitened innovation
  for (int j = 0; j < M; ++j) {
    whitened(j) = innovation(j);
    for (int k = 0; k < j; ++k) whitened(j) -= innovation_root(j, k) * whitened(k);
    whitened(j) *= inverse(j);
    for (int i = 0; i < N; ++i) {
      Real rest = cross(i, j);
      for (int k = 0; k < j; ++k) rest -= innovation_root(j, k) * gain(i, k);
      gain(i, j) = rest * inverse(j);
    }
  }
  for (int j = 0; j < M; ++j) {
    for (int i = 0; i < N; ++i) state.mean(i) += gain(i, j) * whitened(j);
  }
  for (int j = 0; j < M; ++j) {
    if (!rank_one_update<Real, N>(state.root, gain.col(j), Real(-1))) return false;
  }
  return state.mean.allFinite();
}

}  // namespace boresight::tracking::filters
