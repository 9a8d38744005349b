// Normalised estimation error squared (NEES): compares the error of an estimate with its stated covariance.
// Equations: docs/algorithms/alignment.md (A17).
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "services/alignment_estimator/core/config.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

/// eᵀP⁻¹e over the observable ones of (k_v, rotations about the vehicle's axes), divided by their number; 1 if the
/// covariance is right. `actual`: true R(sensor→vehicle). NaN if nothing is observable or the matrix is not a
/// covariance. No allocation.
[[nodiscard]] inline double nees(const RadarEstimate& estimate, double speed_scale, const Eigen::Matrix3d& actual) {
  Eigen::Vector4d error;
  error << speed_scale - estimate.speed_scale, geometry::so3_log(actual * estimate.sensor_to_vehicle.transpose());
  constexpr std::array<std::uint32_t, 4> kAxes{alignment_axis::kSpeedScale, alignment_axis::kVehicleRoll,
                                               alignment_axis::kVehiclePitch, alignment_axis::kVehicleYaw};
  std::array<Eigen::Index, 4> chosen{};
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    if ((estimate.observable & kAxes[i]) != 0) chosen[static_cast<std::size_t>(count++)] = static_cast<Eigen::Index>(i);
  }
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (count == 0) return kUnknown;
  // An unobservable parameter keeps a row of the identity, which adds nothing with an error of 0.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  Eigen::Vector4d known = Eigen::Vector4d::Zero();
  for (Eigen::Index r = 0; r < count; ++r) {
    const Eigen::Index i = chosen[static_cast<std::size_t>(r)];
    known(r) = error(i);
    for (Eigen::Index c = 0; c < count; ++c) {
      covariance(r, c) = estimate.covariance(i, chosen[static_cast<std::size_t>(c)]);
    }
  }
  const Eigen::LLT<Eigen::Matrix4d> factor(covariance);
  if (factor.info() != Eigen::Success) return kUnknown;
  return known.dot(factor.solve(known)) / static_cast<double>(count);
}

}  // namespace boresight::alignment
