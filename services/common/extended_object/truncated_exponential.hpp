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
  const double sinh = std::sinh(a);
  return {half_length_m * (1.0 / std::tanh(a) - 1.0 / a),
          half_length_m * half_length_m * (1.0 / (a * a) - 1.0 / (sinh * sinh))};
}

}  // namespace boresight::extended_object
