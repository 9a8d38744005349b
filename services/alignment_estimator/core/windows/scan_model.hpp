// Velocity of a sensor over ground and its derivatives to the parameters and to the errors of the motion.
#pragma once

#include <array>

#include <Eigen/Core>

#include "services/alignment_estimator/core/windows/point.hpp"

namespace boresight::alignment::windows {

/// Signalled motion at the time that belongs to a scan, and its rates.
struct Motion {
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double acceleration_mps2 = 0.0;
  /// Of signals that change fast enough to tell a time offset; else 0.
  double clear_acceleration_mps2 = 0.0;
  double clear_yaw_acceleration_radps2 = 0.0;
  double yaw_rate_std_radps = 0.0;  ///< of the noise of the signal
};

/// Errors of the motion at one instant: δV, δω, body pitch, side slip.
inline constexpr int kMotionErrors = 4;

/// Velocity g = (1 + e)·Rᵀ·v of the sensor in its own axes (m/s): the range rate of a stationary reflector in the
/// direction u is −u·g.
struct ScanModel {
  Eigen::Vector3d g;
  Eigen::Matrix<double, local::kCurve, 3> by_parameter;  ///< row: ∂g / ∂ a parameter
  Eigen::Matrix<double, kMotionErrors, 3> by_motion;     ///< row: ∂g / ∂ an error of the motion
};

[[nodiscard]] ScanModel model_scan(const Point& point, const std::array<double, 3>& position_m, const Motion& motion);

}  // namespace boresight::alignment::windows
