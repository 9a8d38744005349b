// Velocity of the sensor, and the std of the range rate that it predicts for a stationary reflector.
// Equations: docs/algorithms/correction.md (C3)(C4)(C8).
#pragma once

#include <Eigen/Core>

#include "services/common/estimation/ego_history.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/detection_corrector/core/mounting.hpp"

namespace boresight::corrector {

struct EgoVelocity {
  double speed_mps;            ///< of the rear axle, k_v applied
  double yaw_rate_radps;       ///< without its bias
  Eigen::Vector3d sensor_mps;  ///< over ground, vehicle axes
  /// g = (1 + e)·v_s: the radar measures −(R u)·g of a stationary reflector, with its own scale of range rates.
  Eigen::Vector3d seen_mps;
  Eigen::Matrix3d covariance;  ///< of g, (m/s)²: −d·g of the unit vector d = R u has the variance dᵀ·covariance·d
};

/// v_s = (k_v·V − ω·y_s, −c·V²·ω + ω·x_s, 0), and to first order the covariance of range rates as the radar measures
/// them. It contains the stds of ego speed, yaw rate with its bias and gain (with the lever arm), slip and e, and the
/// covariance of (1 + e)·k_v and mounting. The std of e acts on the lever arm only, since (1 + e)·k_v is known. A
/// mounting error θ moves a range rate by (θ × d)·v_s = d·(v_s × θ). This is linear in d, like all other terms, so one
/// 3×3 form holds all of them. Stds that `sample` does not state are those of `ego`, the vehicle file. `sample` must be
/// valid.
[[nodiscard]] EgoVelocity ego_velocity(const EgoSample& sample, const EgoConfig& ego, const MountingPose& pose,
                                       const Mounting& mounting);

}  // namespace boresight::corrector
