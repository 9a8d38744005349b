#include "services/detection_corrector/core/mounting.hpp"

#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::corrector {

namespace {

constexpr std::size_t kSize = kNumberOfAlignmentParameters;

/// Errors of k_v and of the rotation about the vehicle's x, y, z. The message has k_v, yaw, pitch and roll; the
/// rotation about x, y, z is roll, −pitch, yaw.
Eigen::Matrix4d covariance_of(const AlignmentEstimate& estimate) {
  constexpr std::array<std::size_t, kSize> kRow{0, 3, 2, 1};
  constexpr std::array<double, kSize> kSign{1.0, 1.0, -1.0, 1.0};
  Eigen::Matrix4d covariance;
  for (Eigen::Index r = 0; r < 4; ++r) {
    for (Eigen::Index c = 0; c < 4; ++c) {
      const auto i = static_cast<std::size_t>(r), k = static_cast<std::size_t>(c);
      covariance(r, c) = kSign[i] * kSign[k] * estimate.vehicle_covariance[kRow[i] * kSize + kRow[k]];
    }
  }
  return covariance;
}

/// Splits the rotation along the principal axes of `covariance`. The observable and certain part is applied. The rest
/// widens the covariance, since the truth is distributed about the estimate and not about the applied part.
struct Split {
  Eigen::Vector3d applied = Eigen::Vector3d::Zero();
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
};
Split split(const Eigen::Vector3d& turn, Eigen::Matrix3d covariance, const AlignmentEstimate& estimate,
            double max_std_rad) {
  constexpr std::array<std::uint32_t, 3> kAxis{alignment_axis::kVehicleRoll, alignment_axis::kVehiclePitch,
                                               alignment_axis::kVehicleYaw};
  // An axis that is not observable has no bound, whatever its row of the covariance.
  constexpr double kUnbounded = 10.0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (!estimate.is_observable(kAxis[static_cast<std::size_t>(i)])) covariance(i, i) += kUnbounded;
  }
  Split out;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(covariance);
  if (parts.info() == Eigen::Success) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (parts.eigenvalues()(i) > max_std_rad * max_std_rad) continue;
      out.applied += parts.eigenvectors().col(i) * parts.eigenvectors().col(i).dot(turn);
    }
  }
  Eigen::Vector3d rest = turn - out.applied;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (!estimate.is_observable(kAxis[static_cast<std::size_t>(i)])) rest(i) = 0.0;  // the value is the prior's
  }
  out.left = rest * rest.transpose();
  return out;
}

bool is_estimated(const AlignmentValue& value) {
  return std::isfinite(value.value) && std::isfinite(value.std) && value.std > 0.0F;
}

/// Divides the scale that the radar sees into those of the speed signal and of its range rates.
void split_speed_scale(const AlignmentNuisance& nuisance, Mounting& mounting) {
  const AlignmentValue& scale = nuisance.range_rate_scale;
  if (!is_estimated(scale) || !(scale.value > -0.5F)) return;
  mounting.range_rate_scale = 1.0 + scale.value;
  mounting.speed_scale /= mounting.range_rate_scale;
  mounting.range_rate_scale_variance = std::pow(scale.std, 2);
}

/// Turns the mounting by the load's pitch if that is certain enough, else widens the covariance by it. Returns whether
/// it was applied.
bool add_load(const AlignmentNuisance& nuisance, double max_std_rad, Mounting& mounting) {
  const AlignmentValue& load = nuisance.load_pitch_rad;
  if (!is_estimated(load)) return false;
  constexpr Eigen::Index kAboutY = 2;  // of k_v, x, y, z
  mounting.covariance(kAboutY, kAboutY) += std::pow(load.std, 2);
  if (load.std > max_std_rad) {
    mounting.covariance(kAboutY, kAboutY) += std::pow(load.value, 2);
    return false;
  }
  mounting.sensor_to_vehicle = geometry::so3_exp({0.0, -load.value, 0.0}) * mounting.sensor_to_vehicle;
  return true;
}

/// Applies the estimated yaw-rate bias and gain, slip and time offset, if the message contains them.
void add_motion(const AlignmentEstimate& estimate, Mounting& mounting) {
  const auto known = [&](std::uint32_t axis, float value, float std) {
    return estimate.is_observable(axis) && std::isfinite(value) && std::isfinite(std) && std >= 0.0F;
  };
  if (known(alignment_axis::kYawRateBias, estimate.yaw_rate_bias_radps, estimate.yaw_rate_bias_std_radps)) {
    mounting.yaw_rate_bias_radps = estimate.yaw_rate_bias_radps;
    mounting.yaw_rate_bias_variance = std::pow(estimate.yaw_rate_bias_std_radps, 2);
  }
  if (known(alignment_axis::kSlip, estimate.slip_coefficient_radps2pm, estimate.slip_coefficient_std_radps2pm)) {
    mounting.slip_coefficient_radps2pm = estimate.slip_coefficient_radps2pm;
    mounting.slip_variance = std::pow(estimate.slip_coefficient_std_radps2pm, 2);
  }
  const AlignmentNuisance& nuisance = estimate.nuisance;
  const auto is_learnt = [&](std::uint32_t bit, const AlignmentValue& value) {
    return (nuisance.observable & bit) != 0 && is_estimated(value);
  };
  if (is_learnt(alignment_nuisance::kYawRateGain, nuisance.yaw_rate_gain)) {
    mounting.yaw_rate_gain = 1.0 + nuisance.yaw_rate_gain.value;
    mounting.yaw_rate_gain_variance = std::pow(nuisance.yaw_rate_gain.std, 2);
  }
  if (is_learnt(alignment_nuisance::kTimeOffset, nuisance.time_offset_s)) {
    mounting.time_offset_s = nuisance.time_offset_s.value;
  }
}

}  // namespace

Mounting mounting_of(const RadarConfig& radar, const AlignmentEstimate* estimate, const Config& config) {
  const auto square = [](double x) { return x * x; };
  Mounting mounting;
  mounting.sensor_to_vehicle = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
  const double rotation_variance = square(config.unknown_rotation_std_rad);
  mounting.covariance =
      Eigen::Vector4d(square(config.unknown_speed_scale_std), rotation_variance, rotation_variance, rotation_variance)
          .asDiagonal();
  mounting.yaw_rate_bias_variance = square(config.unknown_yaw_rate_bias_std_radps);
  mounting.slip_variance = square(config.unknown_slip_std_radps2pm);
  // Of wrong inputs an estimate says nothing, however sure it is.
  if (estimate == nullptr || estimate->finding != AlignmentFinding::kNone) return mounting;

  const Eigen::Vector3d turn(estimate->vehicle_roll_rad, -estimate->vehicle_pitch_rad, estimate->vehicle_yaw_rad);
  const Eigen::Matrix4d covariance = covariance_of(*estimate);
  if (!turn.allFinite() || !std::isfinite(estimate->speed_scale) || !covariance.allFinite() ||
      covariance.diagonal().minCoeff() < 0.0) {
    return mounting;
  }
  mounting.covariance = covariance;
  if (estimate->is_observable(alignment_axis::kSpeedScale) &&
      covariance(0, 0) <= square(config.max_speed_scale_std_to_apply)) {
    mounting.speed_scale = estimate->speed_scale;
    split_speed_scale(estimate->nuisance, mounting);
    mounting.alignment_sequence = estimate->header.sequence;
  } else {
    mounting.covariance(0, 0) += square(estimate->speed_scale - 1.0);
  }
  const Split parts = split(turn, covariance.bottomRightCorner<3, 3>(), *estimate, config.max_angle_std_to_apply_rad);
  mounting.covariance.bottomRightCorner<3, 3>() += parts.left;
  if (!parts.applied.isZero(0.0)) {
    mounting.sensor_to_vehicle =
        geometry::fixed_axes_rotation(parts.applied.z(), -parts.applied.y(), parts.applied.x()) *
        mounting.sensor_to_vehicle;
    mounting.alignment_sequence = estimate->header.sequence;
  }
  if (add_load(estimate->nuisance, config.max_angle_std_to_apply_rad, mounting)) {
    mounting.alignment_sequence = estimate->header.sequence;
  }
  mounting.azimuth_curve = AzimuthCurve(estimate->nuisance);
  add_motion(*estimate, mounting);
  if (std::isfinite(estimate->angle_noise_scale) && estimate->angle_noise_scale > 0.0F) {
    mounting.angle_noise_scale = estimate->angle_noise_scale;
  }
  return mounting;
}

}  // namespace boresight::corrector
