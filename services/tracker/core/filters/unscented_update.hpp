// What sigma points state about a measurement: its expected value, the deviations of the points, and the
// cross-covariance with the state. The covariance form and the square-root form share it.
#pragma once

#include "services/tracker/core/filters/sigma_points.hpp"

namespace boresight::tracking::filters {

template <typename Real, int N, int M>
struct ExpectedMeasurement {
  Vector<Real, M> mean;
  Vector<Real, M> centre_deviation;   ///< of the first point
  Matrix<Real, M, 2 * N> deviations;  ///< of the other points, not weighted
  Matrix<Real, N, M> cross;           ///< covariance of state and measurement
};

/// Differences are those of the measurement, so that angles do not jump.
template <typename Real, int N, typename Measurement>
[[nodiscard]] auto expected_measurement(const SigmaPoints<Real, N>& sigma, const Vector<Real, N>& mean,
                                        const Matrix<Real, N, N>& root, const Measurement& measurement) {
  using Value = typename Measurement::Value;
  const typename SigmaPoints<Real, N>::Points points = sigma.of(mean, root);
  ExpectedMeasurement<Real, N, Value::RowsAtCompileTime> result;
  const Value centre = measurement.expected(mean);
  Value offset = Value::Zero();
  for (int j = 0; j < 2 * N; ++j) {
    const Value value = measurement.expected(points.col(1 + j));
    result.deviations.col(j) = value;
    offset += Measurement::difference(value, centre);
  }
  offset *= sigma.weight;
  result.mean = centre + offset;
  result.centre_deviation = -offset;
  result.cross.setZero();
  for (int j = 0; j < 2 * N; ++j) {
    const Value deviation = Measurement::difference(result.deviations.col(j), result.mean);
    result.deviations.col(j) = deviation;
    for (int k = 0; k < Value::RowsAtCompileTime; ++k) {
      const Real weighted = sigma.weight * deviation(k);
      for (int i = 0; i < N; ++i) result.cross(i, k) += (points(i, 1 + j) - mean(i)) * weighted;
    }
  }
  return result;
}

}  // namespace boresight::tracking::filters
