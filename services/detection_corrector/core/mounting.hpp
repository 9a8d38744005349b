// The corrected mounting of a radar and the other values of the alignment estimate, with their covariance.
// Equations: docs/algorithms/correction.md (C1)(C2)(C8)(C9).
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/detection_corrector/core/azimuth_curve.hpp"
#include "services/detection_corrector/core/config.hpp"

namespace boresight::corrector {

struct Mounting {
  Eigen::Matrix3d sensor_to_vehicle;  ///< the load's pitch included
  double speed_scale = 1.0;           ///< true / signalled speed
  double range_rate_scale = 1.0;      ///< 1 + e: measured / true range rate
  double time_offset_s = 0.0;         ///< the ego motion of a scan is that at its stamp + this
  double yaw_rate_bias_radps = 0.0;   ///< true yaw rate = (signalled − bias)·gain
  double yaw_rate_gain = 1.0;
  double slip_coefficient_radps2pm = 0.0;  ///< c of V_y = −c·V·(V·ω)
  double angle_noise_scale = 1.0;          ///< estimated factor of the angles' stds
  AzimuthCurve azimuth_curve;
  /// Covariance of the remaining errors: k_v as the radar sees it (speed_scale · range_rate_scale, known much better
  /// than either factor), then the rotation about the vehicle's x, y, z (left error, Exp(θ)·R); 1
  /// and rad. It contains an estimate that is not applied with its square: E[θθᵀ] about the nominal mounting.
  Eigen::Matrix4d covariance;
  double range_rate_scale_variance = 0.0;
  double yaw_rate_bias_variance = 0.0;
  double yaw_rate_gain_variance = 0.0;
  double slip_variance = 0.0;
  std::uint64_t alignment_sequence = 0;  ///< 0: nothing applied
};

/// The nominal mounting, rotated by the part of the estimated rotation (`estimate` may be null) that is observable and
/// certain enough. The parts are the principal axes of its covariance about the vehicle's axes. Straight driving, for
/// example, determines the pitch of a corner radar about the vehicle's axis and not the roll, so neither its own pitch
/// nor its own roll is known. With a calibration plate it is the opposite. The pitch of the body by its load comes on
/// top, because the estimated rotation is that of the mounting.
[[nodiscard]] Mounting mounting_of(const RadarConfig& radar, const AlignmentEstimate* estimate, const Config& config);

}  // namespace boresight::corrector
