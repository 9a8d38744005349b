// Fault memory ↔ bytes: a frame (services/common/state/frame.hpp, magic "BORFAULT") around operation cycle (u32), its
// id (u64), number of records (u32); per record its trouble code (u32), status byte, counters of failed, healed and
// aged cycles (u8 each), last result (u8), occurrences (u16), then the two freeze frames in the order of their fields.
#pragma once

#include <cstdint>
#include <span>

#include "services/health/core/faults/fault_memory.hpp"

namespace boresight::health {

inline constexpr std::uint32_t kFaultMemoryVersion = 2;
inline constexpr std::size_t kFreezeFrameBytes = 8 + 8 + 9 * 4 + 4 * 4 + 10 * 4 + 8 + 16;
inline constexpr std::size_t kFaultRecordBytes = 4 + 5 + 2 + 2 * kFreezeFrameBytes;
inline constexpr std::size_t kMaxFaultMemoryBytes = 20 + 16 + kNumberOfEventKinds * kMaxRadars * kFaultRecordBytes;

/// Result of reading.
enum class StoredFaults : std::uint8_t {
  kTaken,
  kCorrupt,       ///< truncated, changed, impossible values, or another kind of file
  kOtherVersion,  ///< intact, of a version unknown to this program
};
/// "taken", "corrupt", "of another version".
[[nodiscard]] const char* describe(StoredFaults verdict);

/// Writes the records with a result or a history. Returns the number of bytes; 0 if `out` is too small.
[[nodiscard]] std::size_t encode_fault_memory(const FaultMemory& memory, std::span<std::uint8_t> out);

/// Restores `memory`, which is unchanged unless the verdict is kTaken. Records of events that the vehicle no longer has
/// are not restored.
[[nodiscard]] StoredFaults decode_fault_memory(std::span<const std::uint8_t> bytes, FaultMemory& memory);

}  // namespace boresight::health
