// Start value of the dynamic estimator from a static calibration.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "services/alignment_estimator/core/memory/memory.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// A radar's rotation with its uncertainty: R(actual) = Exp(d)·R(nominal), d in vehicle axes.
struct RotationSeed {
  std::uint32_t radar_id = 0;
  Eigen::Vector3d rotation_vehicle_rad = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of d, rad²
};

/// Uncertainties that the result of the plate does not contain.
struct SeedConfig {
  double placement_yaw_std_rad = 8.7e-4;    ///< 0.05°: alignment of plate and car
  double placement_pitch_std_rad = 8.7e-4;  ///< the same, level of car and plate
  double roll_std_rad = 0.035;              ///< 2°: about the boresight, which the plate does not measure
};

/// Yaw and pitch as in plate::PlateResult, from the sensor's own azimuth and the plate's tilt. The nominal roll is
/// included: a radar mounted upside down sees the plate on the other side. Returns false and leaves `out` unchanged if
/// an argument is not finite, a std is negative, or the radar lies on its side (nominal roll within 30° of ±90°, where
/// its azimuth is elevation).
[[nodiscard]] bool seed_from_plate(const RadarConfig& radar, double yaw_rad, double yaw_std_rad, double pitch_rad,
                                   double pitch_std_rad, const SeedConfig& config, RotationSeed& out);

/// Replaces that radar in the memory: its rotation and its block of the covariance, without correlations and with zero
/// seconds of driving. An unknown radar is added. Returns false and changes nothing if the memory is full or damaged
/// (more radars than places).
[[nodiscard]] bool put_seed(const RotationSeed& seed, Memory& memory);

}  // namespace boresight::alignment
