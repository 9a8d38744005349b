// What the car does to one of its radars: range-rate scale, azimuth-error curve, position, stamps, the road as a
// mirror.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/car/real_car.hpp"

namespace boresight::simulator::car {

/// Error of the measured azimuth as a function of the true azimuth: a few harmonics over the field of view, with mean 0
/// and the stated root mean square over it.
struct AzimuthCurve {
  static constexpr std::size_t kHarmonics = 3;
  double rms_rad = 0.0;
  double middle_rad = 0.0, half_width_rad = 1.0;
  std::array<double, kHarmonics> cos_rad{}, sin_rad{};

  /// Measured − true; beyond the field of view as at its edge.
  [[nodiscard]] double error_rad(double azimuth_rad) const;
};

/// A radar of the car. It is the same in both simulators for the same seed, id and field of view.
struct RadarOfCar {
  double range_rate_scale = 1.0;  ///< measured / true
  AzimuthCurve curve;
  std::array<double, 3> position_error_m{};  ///< true − nominal, vehicle frame
  double stamp_offset_s = 0.0;               ///< stamp − measurement; whole tenths of a millisecond

  /// The nominal mounting at the true position.
  [[nodiscard]] MountingPose true_position(MountingPose nominal) const;
  [[nodiscard]] std::int64_t stamp_offset_ns() const;
};

[[nodiscard]] RadarOfCar radar_of_car(const RealCar& car, std::uint64_t seed, std::uint32_t radar,
                                      const FieldOfView& view);

/// Reflectors lower than this are low: kerbs, rails, bumpers and rims. A choice.
inline constexpr double kLowReflector_m = 1.0;

/// Direction of a low reflector's mirror image in the road, seen from the sensor. Unit vectors in axes with z up. None
/// if the reflector is not low: not from 0 to kLowReflector_m above the road.
[[nodiscard]] std::optional<Eigen::Vector3d> mirrored_by_road(const Eigen::Vector3d& direction, double range_m,
                                                              double sensor_height_m);

}  // namespace boresight::simulator::car
