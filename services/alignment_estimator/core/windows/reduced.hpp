// What one radar saw in one segment, without the fluctuation of that segment.
#pragma once

#include <array>
#include <cmath>

#include <Eigen/LU>

#include "services/alignment_estimator/core/windows/segment.hpp"

namespace boresight::alignment::windows {

using FluctuationMatrix = Eigen::Matrix<double, kFluctuations, kFluctuations>;
using FluctuationColumns = Eigen::Matrix<double, local::kCount, kFluctuations>;
using FluctuationVector = Eigen::Matrix<double, kFluctuations, 1>;

struct Reduced {
  LocalMatrix information;
  LocalVector score;
  FluctuationColumns gain;      ///< L_c·M⁻¹
  FluctuationMatrix posterior;  ///< M⁻¹, the fluctuation's covariance if all else is known
  FluctuationVector raw_score;
};

/// Eliminates a fluctuation with these variances, and one of roll; 0: there is none.
[[nodiscard]] Reduced reduce(const Share& share, const Point& present,
                             const std::array<double, kFluctuations>& variances, double roll_variance = 0.0);

/// Drops the directions of which a share knows less than nothing: the correction for the noise of the angles may take
/// away more than few detections gave. `scale`: of each parameter, its prior std.
void make_positive(Share& share, const LocalVector& scale);

[[nodiscard]] inline double own_relative(const Segment& segment) {
  return std::ldexp(1.0, -segment.level);
}

/// Variances of the radar's own fluctuation in this segment.
[[nodiscard]] inline std::array<double, kFluctuations> own_variances(const Fluctuation& fluctuation,
                                                                     const Segment& segment, const Share& share) {
  std::array<double, kFluctuations> variances = fluctuation.variance;
  for (double& v : variances) v *= own_relative(segment) / share.weight;
  return variances;
}

/// Variance of the mean of an Ornstein–Uhlenbeck process over `length`, relative to its variance.
[[nodiscard]] inline double share_of_mean(double length_s, double correlation_s) {
  const double t = correlation_s / length_s;
  return 2.0 * t * (1.0 - t * (1.0 - std::exp(-1.0 / t)));
}

}  // namespace boresight::alignment::windows
