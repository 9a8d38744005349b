// The density proportional to exp(rate · x) on an interval about zero: its mean and variance in closed form.
//
//     (1)   mean = h · (coth a − 1/a),   variance = h² · (1/a² − 1/sinh² a),   a = rate · h,
//
// with h half of the interval. Both are smooth in the rate, through the uniform density at rate 0.
#pragma once

#include <cmath>

namespace boresight::extended_object {

struct MeanVariance {
  double mean, variance;
};

[[nodiscard]] inline MeanVariance truncated_exponential(double rate_per_m, double half_length_m) {
  const double a = rate_per_m * half_length_m;
  if (std::abs(a) < 0.05) {  // Taylor series: (1) cancels there
    const double a2 = a * a;
    return {half_length_m * a * (1.0 / 3.0 - a2 / 45.0 + 2.0 * a2 * a2 / 945.0),
            half_length_m * half_length_m * (1.0 / 3.0 - a2 / 15.0 + 2.0 * a2 * a2 / 189.0)};
  }
  // With e = exp(−2|a|) − 1: coth |a| = −(2 + e)/e, 1/sinh² a = 4 (1 + e)/e².
  const double e = std::expm1(-2.0 * std::abs(a));
  return {half_length_m * (std::copysign((2.0 + e) / e, a) - 1.0 / a),
          half_length_m * half_length_m * (1.0 / (a * a) - 4.0 * (1.0 + e) / (e * e))};
}

}  // namespace boresight::extended_object
