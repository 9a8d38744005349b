// Range, azimuth and range rate over ground, from a sensor at a given place. Equations: docs/algorithms/tracking.md
// (T23)(T24).
#pragma once

#include <cmath>
#include <numbers>

#include "services/tracker/core/filters/square_root.hpp"

namespace boresight::tracking::filters {

/// Into −π … π, for angles from −3π to 3π.
template <typename Real>
[[nodiscard]] inline Real wrapped(Real angle_rad) {
  if (angle_rad > std::numbers::pi_v<Real>) return angle_rad - Real(2) * std::numbers::pi_v<Real>;
  if (angle_rad < -std::numbers::pi_v<Real>) return angle_rad + Real(2) * std::numbers::pi_v<Real>;
  return angle_rad;
}

/// Values [r, α, ṙ], or [r, α] with M = 2, of a state [x, v_x, a_x, y, v_y, a_y].
template <typename Real, int M = 3>
struct PolarMeasurement {
  static_assert(M == 2 || M == 3);
  using State = Vector<Real, 6>;
  using Value = Vector<Real, M>;

  Vector<Real, 2> sensor_m = Vector<Real, 2>::Zero();  ///< in the axes of the state
  Real sensor_yaw_rad = Real(0);                       ///< direction of azimuth zero, in the axes of the state

  /// Expected value, with the azimuth in the axes of the state. At the sensor the range rate is not a number.
  [[nodiscard]] Value expected(const State& state) const {
    const Real x = state(0) - sensor_m.x(), y = state(3) - sensor_m.y();
    Value value;
    value(0) = std::sqrt(x * x + y * y);
    value(1) = std::atan2(y, x);
    if constexpr (M == 3) value(2) = (x * state(1) + y * state(4)) / value(0);
    return value;
  }

  /// Derivatives of expected(). Not finite at the sensor.
  [[nodiscard]] Matrix<Real, M, 6> jacobian(const State& state) const {
    const Real x = state(0) - sensor_m.x(), y = state(3) - sensor_m.y();
    const Real inverse_range = Real(1) / std::sqrt(x * x + y * y);
    const Real cosine = x * inverse_range, sine = y * inverse_range;
    Matrix<Real, M, 6> h = Matrix<Real, M, 6>::Zero();
    h(0, 0) = cosine;
    h(0, 3) = sine;
    h(1, 0) = -sine * inverse_range;
    h(1, 3) = cosine * inverse_range;
    if constexpr (M == 3) {
      const Real across_mps = cosine * state(4) - sine * state(1);
      h(2, 0) = -sine * across_mps * inverse_range;
      h(2, 3) = cosine * across_mps * inverse_range;
      h(2, 1) = cosine;
      h(2, 4) = sine;
    }
    return h;
  }

  /// Of two expected values, with the azimuth in −π … π.
  [[nodiscard]] static Value difference(const Value& a, const Value& b) {
    Value d = a - b;
    d(1) = wrapped(d(1));
    return d;
  }
  /// Of a measured value, whose azimuth is seen from the sensor's axes and may be of any turn, from an expected one.
  [[nodiscard]] Value innovation(const Value& measured, const Value& expected) const {
    Value d = measured - expected;
    d(1) += sensor_yaw_rad;
    // The remainder is slow, and few radars measure more than one turn.
    const bool is_near = std::abs(d(1)) < Real(3) * std::numbers::pi_v<Real>;
    d(1) = is_near ? wrapped(d(1)) : std::remainder(d(1), Real(2) * std::numbers::pi_v<Real>);
    return d;
  }
};

}  // namespace boresight::tracking::filters
