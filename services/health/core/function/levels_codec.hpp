// Learnt levels ↔ bytes: a frame (services/common/state/frame.hpp, magic "BORLEVEL") around the fingerprints of the
// vehicle and of what the quantities mean (u64 each) and the number of radars (u32); per radar its id (u32), its
// fingerprint (u64), and mean, variance and learnt seconds (f64 each) of detections, range and unexplained detections.
#pragma once

#include <cstdint>
#include <span>

#include "services/common/vehicle/identity.hpp"
#include "services/health/core/config.hpp"
#include "services/health/core/function/radar_levels.hpp"

namespace boresight::health {

inline constexpr std::uint32_t kLevelsVersion = 1;
inline constexpr std::size_t kRadarLevelsBytes = 4 + 8 + 9 * 8;
inline constexpr std::size_t kMaxLevelsBytes = 20 + 8 + 8 + 4 + kMaxRadars * kRadarLevelsBytes;

/// What stored levels must belong to.
struct LevelsIdentity {
  Identity vehicle;
  std::uint64_t quantities = 0;  ///< fingerprint of the settings that the quantities depend on
};
[[nodiscard]] LevelsIdentity levels_identity_of(const VehicleConfig& vehicle, const Config& config);

/// Result of reading.
enum class StoredLevels : std::uint8_t {
  kTaken,
  kCorrupt,             ///< truncated, changed, impossible values, or another kind of file
  kOtherVersion,        ///< intact, of a version unknown to this program
  kForeign,             ///< intact, of another vehicle
  kOtherConfiguration,  ///< intact, of quantities that are defined otherwise
};
/// "taken", "corrupt", "of another version", "of another vehicle", "of another configuration".
[[nodiscard]] const char* describe(StoredLevels verdict);

/// Returns the number of bytes; 0 if `out` is too small or a radar is not the vehicle's.
[[nodiscard]] std::size_t encode_levels(const VehicleLevels& levels, const LevelsIdentity& identity,
                                        std::span<std::uint8_t> out);

/// Writes `levels`, which are unchanged unless the verdict is kTaken. Radars whose mounting or profile has changed
/// since are not included, and counted.
[[nodiscard]] StoredLevels decode_levels(std::span<const std::uint8_t> bytes, const LevelsIdentity& identity,
                                         VehicleLevels& levels, std::size_t& rejected_radars);

}  // namespace boresight::health
