// Memory ↔ bytes. Layout, little-endian, all numbers f64 but the first ones: "BORALIGN", version (u32), length of all
// (u32), fingerprint of the vehicle (u64), number of radars (u32), reserved (u32), boot (u64), ns since it (i64);
// of the vehicle k_v, yaw-rate bias,
// yaw-rate gain, slip coefficient, pitch per acceleration, time offset, load pitch, three fluctuation variances, three
// correlation times, upper triangle of the covariance row by row; per radar id (u32), flags (u32, bit 0: measures
// elevation), fingerprint (u64), rotation about x, y, z, range-rate scale, time offset, position x and y, azimuth
// curve, height excess, mirror share, angle-noise scale, range-rate-noise scale, seconds of drive, three fluctuation
// variances, upper triangle of the covariance; CRC-32/AUTOSAR of all before (u32).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "services/alignment_estimator/core/memory/memory.hpp"
#include "services/common/vehicle/identity.hpp"

namespace boresight::alignment {

inline constexpr std::uint32_t kMemoryVersion = 4;
inline constexpr std::size_t kMemoryHeaderBytes = 48;
inline constexpr std::size_t kMemoryVehicleBytes =
    8 * (7 + 2 * windows::kFluctuations + Memory::kShared * (Memory::kShared + 1) / 2);
inline constexpr std::size_t kMemoryRadarBytes =
    16 + 8 * (12 + windows::kKnots + windows::kFluctuations + Memory::kOwn * (Memory::kOwn + 1) / 2);
inline constexpr std::size_t kMaxMemoryBytes =
    kMemoryHeaderBytes + kMemoryVehicleBytes + kMaxRadars * kMemoryRadarBytes + 4;
using MemoryBytes = std::array<std::uint8_t, kMaxMemoryBytes>;

/// Result of reading.
enum class MemoryVerdict : std::uint8_t {
  kTaken,
  kCorrupt,       ///< truncated, changed, or another kind of file
  kOtherVersion,  ///< intact, of a version unknown to this program
  kForeign,       ///< intact, of another vehicle
  kImplausible,   ///< intact, but values not finite or out of range, or an invalid covariance
};

/// Text for a log line.
[[nodiscard]] const char* describe(MemoryVerdict verdict);

/// Returns the number of bytes written; 0 for a memory with more radars than possible, or with a radar that is not in
/// the identity. No allocation.
[[nodiscard]] std::size_t encode_memory(const Memory& memory, const Identity& identity, MemoryBytes& out);

/// Removes radars whose mounting or profile differs from `identity`, or that the vehicle no longer has.
/// `rejected_radars` counts them. `out` is written only with kTaken.
[[nodiscard]] MemoryVerdict decode_memory(std::span<const std::uint8_t> bytes, const Identity& identity, Memory& out,
                                          std::size_t& rejected_radars);

}  // namespace boresight::alignment
