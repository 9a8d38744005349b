// Velocity of a sensor over ground and its derivatives to everything that is estimated (docs/algorithms/frames.md).
#pragma once

#include <array>

#include <Eigen/Core>

#include "services/alignment_estimator/core/filter/joint_state.hpp"
#include "services/alignment_estimator/core/filter/spread.hpp"

namespace boresight::alignment {

/// Motion as signalled at the time of a scan; the acceleration is that of the speed signal.
struct ScanMotion3d {
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double acceleration_mps2 = 0.0;
};

/// Velocity g = (1 + λ)·Rᵀ·v of the sensor in its own frame, m/s, and its gradient.
struct SensorVelocity {
  Eigen::Vector3d g;
  VelocityGradient gradient;
  /// By what the radar sees: the angles' noise (Support::by_angle_noise) at ln(real/assumed variance)
  /// `log_angle_noise`; and of reflectors in a plane, which do not tell how it is tilted, neither pitch nor roll is
  /// believed: they would act through the tilt of the estimate, not through that of the radar.
  void seen(const Support& support, double log_angle_noise);
};
/// `nuisances`: δV, δω, body pitch, side slip; those of the state at the instant of its last scan, or none.
/// `pitch_share`: NuisanceModel::pitch_share.
[[nodiscard]] SensorVelocity sensor_velocity(const JointState& state, const Eigen::Vector4d& nuisances,
                                             std::size_t radar, const std::array<double, 3>& position_m,
                                             const ScanMotion3d& motion, double pitch_share = 0.0);

}  // namespace boresight::alignment
