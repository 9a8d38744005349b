// Normal distributions of a state: by covariance, or by the lower-triangular square root of the covariance.
#pragma once

#include <Eigen/Core>

#include "services/tracker/core/filters/square_root.hpp"

namespace boresight::tracking::filters {

template <typename Real, int N>
struct Gaussian {
  Vector<Real, N> mean = Vector<Real, N>::Zero();
  Matrix<Real, N, N> covariance = Matrix<Real, N, N>::Identity();
};

/// The covariance is `root` · `root`ᵀ. `root` is lower triangular with a positive diagonal.
template <typename Real, int N>
struct RootGaussian {
  Vector<Real, N> mean = Vector<Real, N>::Zero();
  Matrix<Real, N, N> root = Matrix<Real, N, N>::Identity();
};

template <typename Real, int N>
[[nodiscard]] Gaussian<Real, N> gaussian_of(const RootGaussian<Real, N>& state) {
  return {state.mean, state.root * state.root.transpose()};
}

/// False if the covariance is not positive definite; `root` must not be used then.
template <typename Real, int N>
[[nodiscard]] bool root_of(const Gaussian<Real, N>& state, RootGaussian<Real, N>& root) {
  root.mean = state.mean;
  return state.mean.allFinite() && cholesky(state.covariance, root.root);
}

}  // namespace boresight::tracking::filters
