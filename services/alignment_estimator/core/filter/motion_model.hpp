// Velocity of a sensor over ground and its derivatives to all estimated parameters (docs/algorithms/alignment.md
// (A1)–(A3)).
#pragma once

#include <array>

#include <Eigen/Core>

#include "services/alignment_estimator/core/filter/joint_state.hpp"
#include "services/alignment_estimator/core/filter/spread.hpp"

namespace boresight::alignment {

/// Signalled motion at the time of a scan; the acceleration is that of the speed signal.
struct ScanMotion3d {
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double acceleration_mps2 = 0.0;
  double yaw_acceleration_radps2 = 0.0;
};

/// Velocity g = (1 + λ)·Rᵀ·v of the sensor in its own frame, m/s, and its gradient.
struct SensorVelocity {
  Eigen::Vector3d g;
  VelocityGradient gradient;
  /// Adapts the gradient to the directions that the radar sees. Adds the effect of the angles' noise
  /// (Support::by_angle_noise) at ln(real/assumed variance) = `log_angle_noise`. Reflectors in one plane do not
  /// determine its tilt, so the gradients to pitch and roll are removed: they would come from the estimate, not from
  /// the radar.
  void seen(const Support& support, double log_angle_noise);
};
/// `nuisances`: δV, δω, body pitch, side slip of the state at the instant of its last scan, or zero.
/// `pitch_share`: NuisanceModel::pitch_share.
[[nodiscard]] SensorVelocity sensor_velocity(const JointState& state, const Eigen::Vector4d& nuisances,
                                             std::size_t radar, const std::array<double, 3>& position_m,
                                             const ScanMotion3d& motion, double pitch_share = 0.0);

}  // namespace boresight::alignment
