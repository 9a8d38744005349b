// Measurements that are linear in the state.
#pragma once

#include "services/tracker/core/filters/square_root.hpp"

namespace boresight::tracking::filters {

template <typename Real, int N, int M>
struct LinearMeasurement {
  using State = Vector<Real, N>;
  using Value = Vector<Real, M>;

  Matrix<Real, M, N> matrix = Matrix<Real, M, N>::Zero();

  [[nodiscard]] Value expected(const State& state) const { return matrix * state; }
  [[nodiscard]] const Matrix<Real, M, N>& jacobian(const State&) const { return matrix; }
  [[nodiscard]] static Value difference(const Value& a, const Value& b) { return a - b; }
  [[nodiscard]] Value innovation(const Value& measured, const Value& expected) const { return measured - expected; }
};

/// [x, y] of [x, v_x, a_x, y, v_y, a_y].
template <typename Real>
[[nodiscard]] LinearMeasurement<Real, 6, 2> position_measurement() {
  LinearMeasurement<Real, 6, 2> measurement;
  measurement.matrix(0, 0) = measurement.matrix(1, 3) = Real(1);
  return measurement;
}

/// [v_x, v_y].
template <typename Real>
[[nodiscard]] LinearMeasurement<Real, 6, 2> velocity_measurement() {
  LinearMeasurement<Real, 6, 2> measurement;
  measurement.matrix(0, 1) = measurement.matrix(1, 4) = Real(1);
  return measurement;
}

/// [x, y, ṙ], with the range rate over ground along a known line of sight.
template <typename Real>
[[nodiscard]] LinearMeasurement<Real, 6, 3> position_and_range_rate_measurement(const Vector<Real, 2>& line_of_sight) {
  LinearMeasurement<Real, 6, 3> measurement;
  measurement.matrix(0, 0) = measurement.matrix(1, 3) = Real(1);
  measurement.matrix(2, 1) = line_of_sight.x();
  measurement.matrix(2, 4) = line_of_sight.y();
  return measurement;
}

}  // namespace boresight::tracking::filters
