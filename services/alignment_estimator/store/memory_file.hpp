// The file that keeps a memory across ignition cycles. Whenever the process or the power goes, the file is either what
// it was or what was to be written: the new content goes into a file beside it, to the medium, and only then takes the
// old one's name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "services/alignment_estimator/core/memory/codec.hpp"

namespace boresight::alignment {

/// What was found at start.
struct LoadedMemory {
  enum class Kind : std::uint8_t {
    kMissing,     ///< a first start
    kTaken,       ///< `memory` is to be restored
    kRejected,    ///< kept aside under the same name with ".rejected", and not used
    kUnreadable,  ///< the file system refused; the file stays where it is
  };
  Kind kind = Kind::kMissing;
  MemoryVerdict verdict = MemoryVerdict::kTaken;
  std::size_t left_out = 0;  ///< radars whose mounting or profile changed since
  std::string reason;        ///< of kRejected and kUnreadable
  Memory memory;
};

/// Also removes what a killed writer left behind. Never throws.
[[nodiscard]] LoadedMemory load_memory(const std::filesystem::path& file, const Identity& identity);

/// Temporary file in the same folder, write, fsync, rename, fsync of the folder. Empty if it worked, else what failed;
/// then the old file is as it was. Blocks for as long as the medium takes.
[[nodiscard]] std::string write_memory_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace boresight::alignment
