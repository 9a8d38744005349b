// The vehicle's motion as measured by its own sensors, before the speed scale k_v is applied.
#pragma once

#include "interfaces/messages/header.hpp"

namespace boresight {

/// Bits of `EgoMotion::fields`.
namespace ego_field {
inline constexpr std::uint32_t kSpeed = 1u << 0;
inline constexpr std::uint32_t kYawRate = 1u << 1;
inline constexpr std::uint32_t kSteeringAngle = 1u << 2;
inline constexpr std::uint32_t kReverse = 1u << 3;  ///< the direction of travel is known and is in the sign of speed
}  // namespace ego_field

/// Motion of the rear axle's centre in the vehicle frame.
struct EgoMotion {
  static constexpr std::uint32_t kVersion = 1;

  MessageHeader header;  ///< source_id 0
  std::uint32_t fields;  ///< ego_field bits: quantities whose last value is recent enough for use
  float speed_mps;       ///< + forward, as signalled (multiply by k_v for the true speed)
  float speed_std_mps;
  float yaw_rate_radps;  ///< + to the left
  float yaw_rate_std_radps;
  float steering_angle_rad;  ///< at the steering wheel, + to the left
  float steering_angle_std_rad;
  float longitudinal_acceleration_mps2;  ///< derived from the speed signal, low-passed; 0 if unknown

  [[nodiscard]] bool has(std::uint32_t field_bits) const { return (fields & field_bits) == field_bits; }
};

static_assert(kIsPlainMessage<EgoMotion>);
static_assert(sizeof(EgoMotion) == 136);

}  // namespace boresight
