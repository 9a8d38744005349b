// Unscented Kalman filter by covariance (Julier and Uhlmann 1997). Equations: docs/algorithms/tracking.md (T25)(T27).
#pragma once

#include "services/tracker/core/filters/noise.hpp"
#include "services/tracker/core/filters/unscented_update.hpp"

namespace boresight::tracking::filters {

template <typename Real, int N>
class Unscented {
 public:
  explicit Unscented(const Gaussian<Real, N>& state, const SigmaPointParameters& parameters = {})
      : state_(state), sigma_(parameters) {}

  /// Both return false if a covariance is not positive definite, or a value is not finite. The filter must not be used
  /// then.
  template <typename Motion>
  [[nodiscard]] bool predict(const Motion& motion) {
    Matrix<Real, N, N> root;
    if (!cholesky(state_.covariance, root)) return false;
    typename SigmaPoints<Real, N>::Points points = sigma_.of(state_.mean, root);
    for (int j = 0; j < points.cols(); ++j) {
      Vector<Real, N> point = points.col(j);
      motion.move(point);
      points.col(j) = point;
    }
    const Vector<Real, N> centre = points.col(0);
    Vector<Real, N> offset = Vector<Real, N>::Zero();
    for (int j = 1; j < points.cols(); ++j) offset += points.col(j) - centre;
    offset *= sigma_.weight;
    state_.mean = centre + offset;
    points.colwise() -= state_.mean;
    const auto others = points.template rightCols<2 * N>();
    state_.covariance = motion.noise().covariance;
    state_.covariance += sigma_.centre_weight * points.col(0) * points.col(0).transpose();
    state_.covariance += sigma_.weight * (others * others.transpose());
    return state_.mean.allFinite() && state_.covariance.allFinite();
  }

  template <typename Measurement, int M>
  [[nodiscard]] bool update(const Measurement& measurement, const Vector<Real, M>& value, const Noise<Real, M>& noise) {
    Matrix<Real, N, N> root;
    if (!cholesky(state_.covariance, root)) return false;
    const ExpectedMeasurement<Real, N, M> expected = expected_measurement(sigma_, state_.mean, root, measurement);
    Matrix<Real, M, M> innovation_covariance = noise.covariance;
    innovation_covariance += sigma_.centre_weight * expected.centre_deviation * expected.centre_deviation.transpose();
    innovation_covariance += sigma_.weight * (expected.deviations * expected.deviations.transpose());
    Matrix<Real, M, M> innovation_root;
    if (!cholesky(innovation_covariance, innovation_root)) return false;
    // (T28): the gain of the whitened innovation.
    Matrix<Real, M, N> whitened_cross = expected.cross.transpose();
    innovation_root.template triangularView<Eigen::Lower>().solveInPlace(whitened_cross);
    Vector<Real, M> whitened = measurement.innovation(value, expected.mean);
    innovation_root.template triangularView<Eigen::Lower>().solveInPlace(whitened);
    state_.mean += whitened_cross.transpose() * whitened;
    state_.covariance -= whitened_cross.transpose() * whitened_cross;
    return state_.mean.allFinite() && cholesky(state_.covariance, root);
  }

  [[nodiscard]] Gaussian<Real, N> gaussian() const { return state_; }
  void shift(const Vector<Real, N>& change) { state_.mean += change; }
  [[nodiscard]] bool is_valid() const {
    Matrix<Real, N, N> root;
    return state_.mean.allFinite() && cholesky(state_.covariance, root);
  }

 private:
  Gaussian<Real, N> state_;
  SigmaPoints<Real, N> sigma_;
};

}  // namespace boresight::tracking::filters
