// Reads the file that keeps the alignment over ignition cycles.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "services/alignment_estimator/core/memory/codec.hpp"

namespace boresight::alignment {

/// Result of loading at start.
struct LoadedMemory {
  enum class Kind : std::uint8_t {
    kMissing,     ///< a first start
    kTaken,       ///< `memory` is valid and to be restored
    kRejected,    ///< renamed with the suffix ".rejected", and not used
    kUnreadable,  ///< error of the file system; the file stays in place
  };
  Kind kind = Kind::kMissing;
  MemoryVerdict verdict = MemoryVerdict::kTaken;
  std::size_t rejected_radars = 0;  ///< number of radars whose mounting or profile changed since
  std::string reason;               ///< of kRejected and kUnreadable
  Memory memory;
};

/// As runtime::read_state_file(). Never throws.
[[nodiscard]] LoadedMemory load_memory(const std::filesystem::path& file, const Identity& identity);

}  // namespace boresight::alignment
