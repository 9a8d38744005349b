// Synthetic scans for load tests: deterministic by radar and cycle, and consistent with the synthetic ego motion.
#pragma once

#include <cstdint>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::replay {

inline constexpr float kSyntheticSpeed_mps = 10.0F;

/// Stationary reflectors at random within ±1 rad, ±0.2 rad and 2…150 m, seen from a vehicle that drives straight ahead
/// at kSyntheticSpeed_mps, with range rate noise of 0.05 m/s. Writes all fields except the header; `count` is at most
/// 1024.
void write_synthetic_scan(std::uint32_t radar, const MountingPose& mounting, std::uint32_t cycle, std::uint32_t count,
                          RadarScan& scan);

/// Writes all fields except the header.
void write_synthetic_ego(EgoMotion& ego);

}  // namespace boresight::replay
