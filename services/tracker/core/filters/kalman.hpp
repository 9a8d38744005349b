// Kalman filter (Kalman 1960) and extended Kalman filter, by covariance with the form of Bucy and Joseph 1968.
// Equations: docs/algorithms/tracking.md (T26).
#pragma once

#include <type_traits>

#include "services/tracker/core/filters/gaussian.hpp"
#include "services/tracker/core/filters/linear_measurement.hpp"
#include "services/tracker/core/filters/noise.hpp"

namespace boresight::tracking::filters {

template <typename Real, int N>
class ExtendedKalman {
 public:
  using State = Gaussian<Real, N>;

  /// The covariance is positive definite; checked by is_valid().
  explicit ExtendedKalman(const Gaussian<Real, N>& state) : state_(state) {}

  template <typename Motion>
  [[nodiscard]] bool predict(const Motion& motion) {
    motion.move(state_.mean);
    Matrix<Real, N, N>& covariance = state_.covariance;
    motion.move_columns(covariance);
    covariance.transposeInPlace();
    motion.move_columns(covariance);
    covariance += motion.noise().covariance;
    return state_.mean.allFinite() && covariance.allFinite();
  }

  /// False if the innovation's covariance is not positive definite, or a value is not finite. The filter must not be
  /// used then.
  template <typename Measurement, int M>
  [[nodiscard]] bool update(const Measurement& measurement, const Vector<Real, M>& value, const Noise<Real, M>& noise) {
    const Matrix<Real, M, N> h = measurement.jacobian(state_.mean);
    const Matrix<Real, N, M> cross = state_.covariance * h.transpose();
    const Matrix<Real, M, M> innovation_covariance = h * cross + noise.covariance;
    Matrix<Real, M, M> root;
    if (!cholesky(innovation_covariance, root)) return false;
    Matrix<Real, M, N> transposed_gain = cross.transpose();
    root.template triangularView<Eigen::Lower>().solveInPlace(transposed_gain);
    root.transpose().template triangularView<Eigen::Upper>().solveInPlace(transposed_gain);
    const Matrix<Real, N, M> gain = transposed_gain.transpose();
    state_.mean += gain * measurement.innovation(value, measurement.expected(state_.mean));
    const Matrix<Real, N, N> kept = Matrix<Real, N, N>::Identity() - gain * h;
    const Matrix<Real, N, N> prior = kept * state_.covariance;
    state_.covariance = prior * kept.transpose();
    const Matrix<Real, N, M> noise_gain = gain * noise.root;
    state_.covariance += noise_gain * noise_gain.transpose();
    return state_.mean.allFinite() && state_.covariance.allFinite();
  }

  [[nodiscard]] Gaussian<Real, N> gaussian() const { return state_; }
  /// Moves the mean alone.
  void shift(const Vector<Real, N>& change) { state_.mean += change; }
  [[nodiscard]] bool is_valid() const {
    Matrix<Real, N, N> root;
    return state_.mean.allFinite() && cholesky(state_.covariance, root);
  }

 private:
  State state_;
};

/// The same for measurements that are linear in the state, where it is exact.
template <typename Real, int N>
class Kalman : public ExtendedKalman<Real, N> {
 public:
  using ExtendedKalman<Real, N>::ExtendedKalman;

  template <int M>
  [[nodiscard]] bool update(const LinearMeasurement<Real, N, M>& measurement, const Vector<Real, M>& value,
                            const Noise<Real, M>& noise) {
    return ExtendedKalman<Real, N>::update(measurement, value, noise);
  }
};

}  // namespace boresight::tracking::filters
