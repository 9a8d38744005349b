// What a static calibration tells the dynamic estimator to start from.
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

/// What a plate's result does not know itself.
struct SeedConfig {
  double placement_yaw_std_rad = 8.7e-4;    ///< 0.05°: how well the plate and the car stand to one another
  double placement_pitch_std_rad = 8.7e-4;  ///< the same, level of car and plate
  double roll_std_rad = 0.035;              ///< 2°: about boresight, which no plate shows
};

/// Yaw and pitch as in plate::PlateResult, from the sensor's own azimuth and the plate's tilt. The nominal roll is
/// taken into account (a radar upside down sees the plate on the other side). False, and `out` is untouched, where an
/// argument is not finite, a std is negative, or the radar lies on its side (nominal roll within 30° of ±90°: its
/// azimuth then is elevation).
[[nodiscard]] bool seed_from_plate(const RadarConfig& radar, double yaw_rad, double yaw_std_rad, double pitch_rad,
                                   double pitch_std_rad, const SeedConfig& config, RotationSeed& out);

/// Replaces what the memory holds of that radar: rotation, its block of the covariance, no correlation with anything
/// else, no seconds of drive. A radar that the memory does not know is added. False, and nothing changes, where the
/// memory is full or damaged (more radars than places).
[[nodiscard]] bool put_seed(const RotationSeed& seed, Memory& memory);

}  // namespace boresight::alignment
