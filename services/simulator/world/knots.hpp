// Values that change smoothly between knots.
#pragma once

#include "services/simulator/scenario.hpp"

namespace boresight::simulator {

struct Smooth {
  double value = 0.0;
  double slope = 0.0;      ///< first derivative
  double curvature = 0.0;  ///< second derivative
};

/// The value at `x`. Between two knots it follows the quintic step, whose first and second derivative vanish at both
/// ends. Before the first and after the last knot it is constant. Knots are sorted by `at`; without knots the value
/// is 0.
[[nodiscard]] Smooth smooth(const Knots& knots, double x);

/// Integral of the value from 0 to `x`, which may be negative.
[[nodiscard]] double integral(const Knots& knots, double x);

}  // namespace boresight::simulator
