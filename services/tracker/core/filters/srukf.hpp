// Square-root unscented Kalman filter (van der Merwe and Wan 2001), the full form: sigma points in prediction and
// update, square roots by QR and rank-one updates. Equations: docs/algorithms/tracking.md (T25)(T28).
#pragma once

#include "services/tracker/core/filters/gain.hpp"
#include "services/tracker/core/filters/noise.hpp"
#include "services/tracker/core/filters/unscented_update.hpp"

namespace boresight::tracking::filters {

/// Update by sigma points and QR. False if a root is not that of a positive definite covariance, or a value is not
/// finite; `state` must not be used then.
template <typename Real, int N, typename Measurement, int M>
[[nodiscard]] bool update_root_by_sigma_points(RootGaussian<Real, N>& state, const SigmaPoints<Real, N>& sigma,
                                               const Measurement& measurement, const Vector<Real, M>& value,
                                               const Noise<Real, M>& noise) {
  const ExpectedMeasurement<Real, N, M> expected = expected_measurement(sigma, state.mean, state.root, measurement);
  Matrix<Real, 2 * N + M, M> rows;
  const Real factor = std::sqrt(sigma.weight);
  for (int k = 0; k < M; ++k) {
    for (int j = 0; j < 2 * N; ++j) rows(j, k) = factor * expected.deviations(k, j);
    for (int j = 0; j < M; ++j) rows(2 * N + j, k) = noise.root(k, j);
  }
  Matrix<Real, M, M> innovation_root;
  qr_root(rows, innovation_root);
  if (!rank_one_update<Real, M>(innovation_root, expected.centre_deviation, sigma.centre_weight)) return false;
  return apply_gain<Real, N, M>(state, innovation_root, expected.cross, measurement.innovation(value, expected.mean));
}

template <typename Real, int N>
class SquareRootUnscented {
 public:
  /// is_valid() is false if the covariance is not positive definite.
  explicit SquareRootUnscented(const Gaussian<Real, N>& state, const SigmaPointParameters& parameters = {})
      : sigma_(parameters), is_valid_(root_of(state, state_)) {}

  template <typename Motion>
  [[nodiscard]] bool predict(const Motion& motion) {
    typename SigmaPoints<Real, N>::Points points = sigma_.of(state_.mean, state_.root);
    for (int j = 0; j < 2 * N + 1; ++j) {
      Vector<Real, N> point = points.col(j);
      motion.move(point);
      points.col(j) = point;
    }
    Vector<Real, N> offset = Vector<Real, N>::Zero();
    for (int j = 1; j < 2 * N + 1; ++j) offset += points.col(j) - points.col(0);
    offset *= sigma_.weight;
    state_.mean = points.col(0) + offset;
    Matrix<Real, 3 * N, N> rows;
    const Real factor = std::sqrt(sigma_.weight);
    for (int k = 0; k < N; ++k) {
      for (int j = 0; j < 2 * N; ++j) rows(j, k) = factor * (points(k, 1 + j) - state_.mean(k));
      for (int j = 0; j < N; ++j) rows(2 * N + j, k) = motion.noise().root(k, j);
    }
    qr_root(rows, state_.root);
    return rank_one_update<Real, N>(state_.root, -offset, sigma_.centre_weight) && state_.mean.allFinite();
  }

  template <typename Measurement, int M>
  [[nodiscard]] bool update(const Measurement& measurement, const Vector<Real, M>& value, const Noise<Real, M>& noise) {
    return update_root_by_sigma_points(state_, sigma_, measurement, value, noise);
  }

  [[nodiscard]] Gaussian<Real, N> gaussian() const { return gaussian_of(state_); }
  [[nodiscard]] const RootGaussian<Real, N>& root() const { return state_; }
  void shift(const Vector<Real, N>& change) { state_.mean += change; }
  [[nodiscard]] bool is_valid() const { return is_valid_; }

 private:
  RootGaussian<Real, N> state_;
  SigmaPoints<Real, N> sigma_;
  bool is_valid_;
};

}  // namespace boresight::tracking::filters
