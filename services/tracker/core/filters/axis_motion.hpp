// Motion along one axis: place, velocity, and an acceleration that random jerk changes and that may fade (Singer 1970).
// Equations: docs/algorithms/tracking.md (T21)(T22).
#pragma once

#include <limits>

#include <Eigen/Core>

namespace boresight::tracking::filters {

/// Process noise: white jerk changes the acceleration, which fades with time.
struct ProcessNoise {
  double jerk_density_m2ps5 = 1.0;                                        ///< of white jerk, the same along each axis
  double acceleration_decay_s = std::numeric_limits<double>::infinity();  ///< infinite: accelerations last

  /// Finite density that is not negative, positive time of decay.
  [[nodiscard]] bool is_valid() const;
};

/// Over one step: state ← transition · state + noise.
struct AxisMotion {
  Eigen::Matrix3d transition;  ///< upper triangular
  Eigen::Matrix3d covariance;  ///< of the noise
};

/// A step back (negative time) is the exact inverse of the step forward and has no noise. `noise` is valid, the time
/// is finite.
[[nodiscard]] AxisMotion axis_motion(double elapsed_s, const ProcessNoise& noise);

}  // namespace boresight::tracking::filters
