// The mounting of a radar and what else the alignment estimate knows, as far as it is sure, and how wrong that may be.
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
  double angle_noise_scale = 1.0;          ///< of the angles' stds, as they really are
  /// Of errors that are left: k_v, then the turn about the vehicle's x, y, z (left error, Exp(θ)·R); 1 and rad. What is
  /// estimated but not applied is in it as it would have been applied: E[θθᵀ] about the nominal mounting.
  Eigen::Matrix4d covariance;
  double yaw_rate_bias_variance = 0.0;
  double slip_variance = 0.0;
  std::uint64_t alignment_sequence = 0;  ///< 0: nothing applied
};

/// The nominal mounting turned by that part of the estimated rotation (`estimate` may be null) which is observable and
/// sure enough. The parts are the principal axes of its covariance about the vehicle's axes: of a radar that looks to
/// the side straight driving tells the pitch about the vehicle's axis and not the roll, so that neither pitch nor roll
/// about its own axes is known; a calibration plate tells the opposite.
[[nodiscard]] Mounting mounting_of(const RadarConfig& radar, const AlignmentEstimate* estimate, const Config& config);

}  // namespace boresight::corrector
