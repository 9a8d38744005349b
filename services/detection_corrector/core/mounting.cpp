#include "services/detection_corrector/core/mounting.hpp"

#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::corrector {

namespace {

/// Of the turn about the vehicle's x, y, z axes, what is observable and sure; zero if that is nothing.
Eigen::Vector3d sure_turn(const AlignmentEstimate& estimate, double max_std_rad) {
  const Eigen::Vector3d turn(estimate.vehicle_roll_rad, -estimate.vehicle_pitch_rad, estimate.vehicle_yaw_rad);
  // Rows of the message's covariance are k_v, yaw, pitch, roll; those of the turn about x, y, z are roll, −pitch, yaw.
  constexpr std::array<std::size_t, 3> kRow{3, 2, 1};
  constexpr std::array<double, 3> kSign{1.0, -1.0, 1.0};
  constexpr std::array<std::uint32_t, 3> kAxis{alignment_axis::kVehicleRoll, alignment_axis::kVehiclePitch,
                                               alignment_axis::kVehicleYaw};
  Eigen::Matrix3d covariance;
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(r), k = static_cast<std::size_t>(c);
      covariance(r, c) =
          kSign[i] * kSign[k] * estimate.vehicle_covariance[kRow[i] * kNumberOfAlignmentParameters + kRow[k]];
    }
  }
  if (!turn.allFinite() || !covariance.allFinite() || covariance.diagonal().minCoeff() < 0.0) {
    return Eigen::Vector3d::Zero();
  }
  // An axis that is not observable may be off by anything, whatever its row says.
  constexpr double kAnything = 10.0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (!estimate.is_observable(kAxis[static_cast<std::size_t>(i)])) covariance(i, i) += kAnything;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(covariance);
  if (parts.info() != Eigen::Success) return Eigen::Vector3d::Zero();
  Eigen::Vector3d sure = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (parts.eigenvalues()(i) > max_std_rad * max_std_rad) continue;
    sure += parts.eigenvectors().col(i) * parts.eigenvectors().col(i).dot(turn);
  }
  return sure;
}

}  // namespace

Mounting mounting_of(const RadarConfig& radar, const AlignmentEstimate* estimate, const Config& config) {
  Mounting mounting;
  mounting.sensor_to_vehicle = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
  if (estimate == nullptr) return mounting;
  const double scale_variance = estimate->covariance[0];
  const double max_std = config.max_speed_scale_std_to_apply;
  if (estimate->is_observable(alignment_axis::kSpeedScale) && std::isfinite(estimate->speed_scale) &&
      scale_variance >= 0.0 && scale_variance <= max_std * max_std) {
    mounting.speed_scale = estimate->speed_scale;
    mounting.alignment_sequence = estimate->header.sequence;
  }
  const Eigen::Vector3d turn = sure_turn(*estimate, config.max_angle_std_to_apply_rad);
  if (!turn.isZero(0.0)) {
    mounting.sensor_to_vehicle =
        geometry::fixed_axes_rotation(turn.z(), -turn.y(), turn.x()) * mounting.sensor_to_vehicle;
    mounting.alignment_sequence = estimate->header.sequence;
  }
  return mounting;
}

}  // namespace boresight::corrector
