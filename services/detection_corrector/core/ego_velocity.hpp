// How the sensor moves, and how wrong the range rate may be that this predicts for what stands still.
// Equations: docs/algorithms/correction.md (C3)(C4).
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
  Eigen::Matrix3d covariance;  ///< (m/s)²: −(R u)·v_s of the unit vector d = R u has the variance dᵀ·covariance·d
};

/// v_s = (k_v·V − ω·y_s, −c·V²·ω + ω·x_s, 0) and, to first order, what the stds of ego speed, yaw rate and its bias
/// (with the lever arm), slip, and the covariance of k_v and mounting make of range rates: a mounting off by the turn θ
/// moves them by (θ × d)·v_s = d·(v_s × θ), which is linear in d as the rest is, so that one 3×3 form holds all of it.
/// Stds of `ego` that are none are those of the vehicle file. `sample` must be valid.
[[nodiscard]] EgoVelocity ego_velocity(const EgoSample& sample, const EgoConfig& ego, const MountingPose& pose,
                                       const Mounting& mounting);

}  // namespace boresight::corrector
