// Kernels of square-root filters: Cholesky root, QR by Householder reflections, and change of a root by one vector
// (Golub and Van Loan 2013). Plain loops over matrices of fixed size; nothing allocates.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace boresight::tracking::filters {

template <typename Real, int N>
using Vector = Eigen::Matrix<Real, N, 1>;
template <typename Real, int Rows, int Columns>
using Matrix = Eigen::Matrix<Real, Rows, Columns>;

/// Lower-triangular `root` with `root` · `root`ᵀ = `square`, of which the lower triangle is read. False if `square` is
/// not positive definite or not finite; `root` must not be used then.
template <typename Real, int N>
[[nodiscard]] bool cholesky(const Matrix<Real, N, N>& square, Matrix<Real, N, N>& root) {
  for (int j = 0; j < N; ++j) {
    Real rest = square(j, j);
    for (int k = 0; k < j; ++k) rest -= root(j, k) * root(j, k);
    if (!(rest > Real(0)) || !std::isfinite(rest)) return false;
    root(j, j) = std::sqrt(rest);
    const Real inverse = Real(1) / root(j, j);
    for (int i = j + 1; i < N; ++i) {
      Real sum = square(i, j);
      for (int k = 0; k < j; ++k) sum -= root(i, k) * root(j, k);
      root(i, j) = sum * inverse;
    }
    for (int i = 0; i < j; ++i) root(i, j) = Real(0);
  }
  return true;
}

/// Householder reflections that leave zeros below the diagonal in the first `Reflected` columns.
template <int Reflected, typename Real, int Rows, int Columns>
void reflect_columns(Matrix<Real, Rows, Columns>& rows) {
  for (int k = 0; k < Reflected; ++k) {
    Real square = Real(0);
    for (int i = k; i < Rows; ++i) square += rows(i, k) * rows(i, k);
    const Real diagonal = rows(k, k) > Real(0) ? -std::sqrt(square) : std::sqrt(square);
    const Real first = rows(k, k) - diagonal;
    const Real reflector_square = square - rows(k, k) * rows(k, k) + first * first;
    if (reflector_square > Real(0)) {
      const Real scale = Real(2) / reflector_square;
      rows(k, k) = first;
      for (int j = k + 1; j < Columns; ++j) {
        Real along = Real(0);
        for (int i = k; i < Rows; ++i) along += rows(i, k) * rows(i, j);
        along *= scale;
        for (int i = k; i < Rows; ++i) rows(i, j) -= along * rows(i, k);
      }
    }
    rows(k, k) = diagonal;
  }
}

/// Lower-triangular `root` with `root` · `root`ᵀ = `rows`ᵀ · `rows`: the triangular factor of the QR decomposition,
/// transposed, with a diagonal that is not negative. Overwrites `rows`.
template <typename Real, int Rows, int N>
void qr_root(Matrix<Real, Rows, N>& rows, Matrix<Real, N, N>& root) {
  static_assert(Rows >= N);
  reflect_columns<N>(rows);
  for (int k = 0; k < N; ++k) {
    const Real sign = rows(k, k) < Real(0) ? Real(-1) : Real(1);
    for (int j = 0; j < k; ++j) root(j, k) = Real(0);
    for (int j = k; j < N; ++j) root(j, k) = sign * rows(k, j);
  }
}

/// Changes `root` so that its square grows by `weight` · `vector` · `vector`ᵀ. A negative weight is a downdate. False
/// if the square would not be positive definite, or is not finite; `root` must not be used then.
template <typename Real, int N>
[[nodiscard]] bool rank_one_update(Matrix<Real, N, N>& root, Vector<Real, N> vector, Real weight) {
  const Real sign = weight < Real(0) ? Real(-1) : Real(1);
  vector *= std::sqrt(std::abs(weight));
  for (int k = 0; k < N; ++k) {
    const Real square = root(k, k) * root(k, k) + sign * vector(k) * vector(k);
    if (!(square > Real(0))) return false;
    const Real length = std::sqrt(square), inverse = Real(1) / root(k, k);
    const Real cosine = length * inverse, sine = vector(k) * inverse, inverse_cosine = root(k, k) / length;
    root(k, k) = length;
    for (int i = k + 1; i < N; ++i) {
      root(i, k) = (root(i, k) + sign * sine * vector(i)) * inverse_cosine;
      vector(i) = cosine * vector(i) - sine * root(i, k);
    }
  }
  return root.diagonal().allFinite();
}

}  // namespace boresight::tracking::filters
