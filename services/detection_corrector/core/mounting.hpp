// The corrected mounting of a radar and the other values of the alignment estimate, with their covariance.
// Equations: docs/algorithms/correction.md (C1)(C2).
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/detection_corrector/core/config.hpp"

namespace boresight::corrector {

struct Mounting {
  Eigen::Matrix3d sensor_to_vehicle;
  double speed_scale = 1.0;
  double yaw_rate_bias_radps = 0.0;        ///< signalled = true + bias
  double slip_coefficient_radps2pm = 0.0;  ///< c of V_y = −c·V·(V·ω)
  double angle_noise_scale = 1.0;          ///< estimated factor of the angles' stds
  /// Covariance of the remaining errors: k_v, then the rotation about the vehicle's x, y, z (left error, Exp(θ)·R); 1
  /// and rad. It contains an estimate that is not applied with its square: E[θθᵀ] about the nominal mounting.
  Eigen::Matrix4d covariance;
  double yaw_rate_bias_variance = 0.0;
  double slip_variance = 0.0;
  std::uint64_t alignment_sequence = 0;  ///< 0: nothing applied
};

/// The nominal mounting, rotated by the part of the estimated rotation (`estimate` may be null) that is observable and
/// certain enough. The parts are the principal axes of its covariance about the vehicle's axes. Straight driving, for
/// example, determines the pitch of a corner radar about the vehicle's axis and not the roll, so neither its own pitch
/// nor its own roll is known. With a calibration plate it is the opposite.
[[nodiscard]] Mounting mounting_of(const RadarConfig& radar, const AlignmentEstimate* estimate, const Config& config);

}  // namespace boresight::corrector
