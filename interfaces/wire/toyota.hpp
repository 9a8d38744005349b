// Toyota's radar tracks (object tracks of one radar, 16 slots, 20 Hz) and the ego signals of the same cars.
// Reference: the public DBC files toyota_adas.dbc and toyota_2017_ref_pt.dbc of the opendbc project; a test compares
// this header with them.
#pragma once

#include <cstdint>
#include <span>

#include "interfaces/wire/can_signal.hpp"

namespace boresight::wire::toyota {

// --- radar: TRACK_A_n at 0x210 + n, TRACK_B_n at 0x220 + n, n = 0 … 15 ---------------------------------------------
inline constexpr std::uint32_t kTrackA = 0x210;
inline constexpr std::uint32_t kTrackB = 0x220;
inline constexpr std::uint32_t kNumberOfTracks = 16;
inline constexpr std::size_t kTrackABytes = 8;
inline constexpr std::size_t kTrackBMinBytes = 6;  ///< 0x228 and up have six bytes

inline constexpr CanSignal kCounter{"COUNTER", 7, 8, ByteOrder::kMotorola, false, 1.0, 0.0};
inline constexpr CanSignal kLongitudinalDistance_m{"LONG_DIST", 15, 15, ByteOrder::kMotorola, false, 0.01, 0.0};
inline constexpr CanSignal kLateralDistance_m{"LAT_DIST", 31, 11, ByteOrder::kMotorola, true, 0.04, 0.0};  ///< + right
inline constexpr CanSignal kNewTrack{"NEW_TRACK", 36, 1, ByteOrder::kMotorola, false, 1.0, 0.0};
inline constexpr CanSignal kRelativeSpeed_mps{"REL_SPEED", 47, 12, ByteOrder::kMotorola, true, 0.025, 0.0};
inline constexpr CanSignal kValid{"VALID", 48, 1, ByteOrder::kMotorola, false, 1.0, 0.0};
inline constexpr CanSignal kScore_percent{"SCORE", 23, 8, ByteOrder::kMotorola, false, 1.0, 0.0};
/// Distance the radar reports for a slot without a track.
inline constexpr double kNoTrackDistance_m = 300.0;

// --- ego ------------------------------------------------------------------------------------------------------------
inline constexpr std::uint32_t kYawRateId = 0x024;
inline constexpr std::uint32_t kSteeringId = 0x025;
inline constexpr std::uint32_t kWheelSpeedsId = 0x0AA;
inline constexpr std::uint32_t kSpeedId = 0x0B4;  ///< the speedometer's value, 2 % too high; not used

inline constexpr CanSignal kYawRate_degps{"YR", 1, 10, ByteOrder::kMotorola, false, 0.244, -125.0};  ///< + left
inline constexpr CanSignal kSteeringAngle_deg{"SSA", 3, 12, ByteOrder::kMotorola, true, 1.5, 0.0};   ///< + left
inline constexpr CanSignal kSteeringFraction_deg{"SSAS", 39, 4, ByteOrder::kMotorola, true, 0.1, 0.0};
inline constexpr CanSignal kWheelFrontRight_kmph{"VXFR", 6, 15, ByteOrder::kMotorola, false, 0.01, -67.67};
inline constexpr CanSignal kWheelFrontLeft_kmph{"VXFL", 22, 15, ByteOrder::kMotorola, false, 0.01, -67.67};
inline constexpr CanSignal kWheelRearRight_kmph{"VXRR", 38, 15, ByteOrder::kMotorola, false, 0.01, -67.67};
inline constexpr CanSignal kWheelRearLeft_kmph{"VXRL", 54, 15, ByteOrder::kMotorola, false, 0.01, -67.67};

/// Sum over id, length and all bytes except the last, which holds the sum. 0x0AA and the short frames have none.
[[nodiscard]] constexpr std::uint8_t checksum(std::uint32_t id, std::span<const std::uint8_t> payload) {
  std::uint32_t sum = (id & 0xFFu) + (id >> 8) + static_cast<std::uint32_t>(payload.size());
  for (std::size_t i = 0; i + 1 < payload.size(); ++i) sum += payload[i];
  return static_cast<std::uint8_t>(sum);
}

}  // namespace boresight::wire::toyota
