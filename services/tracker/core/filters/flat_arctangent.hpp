// Angle of a vector without branches, so that a loop over several vectors is compiled to vector instructions.
#pragma once

#include <cmath>
#include <numbers>

namespace boresight::tracking::filters {

/// As std::atan2(y, x), to two units in the last place of double precision. Rational approximation of Moshier 1989.
template <typename Real>
[[nodiscard]] inline Real flat_arctangent(Real y, Real x) {
  const Real height = std::abs(y), width = std::abs(x);
  const bool is_steep = height > width;
  const Real tangent = (is_steep ? width : height) / (is_steep ? height : width);
  const bool is_over_22_5_degrees = tangent > Real(std::numbers::sqrt2 - 1.0);
  const Real reduced = is_over_22_5_degrees ? (tangent - Real(1)) / (tangent + Real(1)) : tangent;
  const Real square = reduced * reduced;
  Real numerator = Real(-8.750608600031904122785e-1);
  numerator = numerator * square - Real(1.615753718733365076637e1);
  numerator = numerator * square - Real(7.500855792314704667340e1);
  numerator = numerator * square - Real(1.228866684490136173410e2);
  numerator = numerator * square - Real(6.485021904942025371773e1);
  Real denominator = square + Real(2.485846490142306297962e1);
  denominator = denominator * square + Real(1.650270098316988542046e2);
  denominator = denominator * square + Real(4.328810604912902668951e2);
  denominator = denominator * square + Real(4.853903996359136964868e2);
  denominator = denominator * square + Real(1.945506571482613964425e2);
  Real angle = reduced + reduced * square * (numerator / denominator);
  angle = is_over_22_5_degrees ? angle + std::numbers::pi_v<Real> / Real(4) : angle;
  angle = is_steep ? std::numbers::pi_v<Real> / Real(2) - angle : angle;
  angle = x < Real(0) ? std::numbers::pi_v<Real> - angle : angle;
  return y < Real(0) ? -angle : angle;
}

}  // namespace boresight::tracking::filters
