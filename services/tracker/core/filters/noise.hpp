// Noise of a motion or of a measurement: covariance and its square root, made once and used in many steps.
#pragma once

#include <cmath>
#include <optional>

#include "services/tracker/core/filters/square_root.hpp"

namespace boresight::tracking::filters {

template <typename Real, int N>
struct Noise {
  Matrix<Real, N, N> covariance = Matrix<Real, N, N>::Zero();
  Matrix<Real, N, N> root = Matrix<Real, N, N>::Zero();  ///< lower triangular, covariance = root · rootᵀ
};

/// Independent components, from their standard deviations.
template <typename Real, int N>
[[nodiscard]] Noise<Real, N> independent_noise(const Vector<double, N>& std) {
  Noise<Real, N> noise;
  noise.root.diagonal() = std.template cast<Real>();
  noise.covariance.diagonal() = std.cwiseAbs2().template cast<Real>();
  return noise;
}

/// Nothing if the covariance is not positive definite or not finite. Its lower triangle is read.
template <typename Real, int N>
[[nodiscard]] std::optional<Noise<Real, N>> noise_of(const Matrix<double, N, N>& covariance) {
  Matrix<double, N, N> root;
  if (!cholesky(covariance, root)) return std::nullopt;
  return Noise<Real, N>{(root * root.transpose()).template cast<Real>(), root.template cast<Real>()};
}

}  // namespace boresight::tracking::filters
