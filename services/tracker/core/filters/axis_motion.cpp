#include "services/tracker/core/filters/axis_motion.hpp"

#include <cmath>

namespace boresight::tracking::filters {

namespace {

/// Σ_m (−x)^m / (m + order)!, which is (e^−x − the terms below the order) / (−x)^order without its cancellation.
double exponential_remainder(double x, int order) {
  double term = 1.0;
  for (int i = 2; i <= order; ++i) term /= i;
  double sum = term;
  for (int n = order + 1;; ++n) {
    term *= -x / n;
    if (sum + term == sum) return sum;
    sum += term;
  }
}

/// Number of subsets of n elements with fewer than `order` elements, for orders up to 2.
double smaller_subsets(int n, int order) {
  return order == 0 ? 0.0 : order == 1 ? 1.0 : 1.0 + n;
}

/// ∫₀¹ of the product of the responses of two orders to jerk at unit density: (T22) without its power of time.
double response_product(double x, int first, int second) {
  const int orders = first + second;
  double power = 1.0, factorial = 1.0, subsets = 1.0;  // (−x)^(n − orders), (n + 1)!, 2^n
  for (int n = 1; n <= orders; ++n) factorial *= n, subsets *= 2.0;
  double sum = 0.0;
  for (int n = orders;; ++n) {
    factorial *= n + 1;
    const double term = power * (subsets - smaller_subsets(n, first) - smaller_subsets(n, second)) / factorial;
    if (sum + term == sum) return sum;
    sum += term;
    power *= -x;
    subsets *= 2.0;
  }
}

Eigen::Matrix3d transition_of(double elapsed_s, double decays) {
  Eigen::Matrix3d transition = Eigen::Matrix3d::Identity();
  transition(0, 1) = elapsed_s;
  transition(0, 2) = elapsed_s * elapsed_s * exponential_remainder(decays, 2);
  transition(1, 2) = elapsed_s * exponential_remainder(decays, 1);
  transition(2, 2) = std::exp(-decays);
  return transition;
}

}  // namespace

bool ProcessNoise::is_valid() const {
  return std::isfinite(jerk_density_m2ps5) && jerk_density_m2ps5 >= 0.0 && acceleration_decay_s > 0.0;
}

AxisMotion axis_motion(double elapsed_s, const ProcessNoise& noise) {
  const double decays = elapsed_s / noise.acceleration_decay_s;
  if (std::abs(decays) > 1.0) {
    // The series are good for short steps; all terms of this sum are positive.
    const AxisMotion half = axis_motion(0.5 * elapsed_s, noise);
    return {half.transition * half.transition,
            half.transition * half.covariance * half.transition.transpose() + half.covariance};
  }
  AxisMotion motion{transition_of(elapsed_s, decays), Eigen::Matrix3d::Zero()};
  if (elapsed_s <= 0.0) return motion;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      // The acceleration is the response of order 0, the place that of order 2.
      const double value =
          noise.jerk_density_m2ps5 * std::pow(elapsed_s, 5 - i - j) * response_product(decays, 2 - i, 2 - j);
      motion.covariance(i, j) = motion.covariance(j, i) = value;
    }
  }
  return motion;
}

}  // namespace boresight::tracking::filters
