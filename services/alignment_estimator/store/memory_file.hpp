// The file that keeps a memory over ignition cycles. After a crash or a power failure the file holds either the old or
// the new content: the new content is written to another file, synchronised with the medium, and then renamed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
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

/// Also removes the temporary file of a killed writer. Never throws.
[[nodiscard]] LoadedMemory load_memory(const std::filesystem::path& file, const Identity& identity);

/// Temporary file in the same folder, write, fsync, rename, fsync of the folder. Returns an empty string, or the failed
/// operation; the old file is then unchanged. Blocks as long as the medium needs.
[[nodiscard]] std::string write_memory_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace boresight::alignment
