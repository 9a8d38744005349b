// A small file that keeps a state over restarts. After a crash or a power failure the file holds either the old or the
// new content: the new content is written to another file, synchronised with the medium, and then renamed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace boresight::runtime {

/// Result of reading.
struct StateBytes {
  enum class Kind : std::uint8_t {
    kMissing,     ///< a first start
    kRead,        ///< `size` bytes were read; a longer file fills the buffer
    kUnreadable,  ///< error of the file system, or no regular file; the file stays in place
  };
  Kind kind = Kind::kMissing;
  std::size_t size = 0;
  std::string reason;  ///< of kUnreadable
};

/// Also removes the temporary file of a killed writer. Reads regular files only, so that a FIFO or a device does not
/// block. Never throws.
[[nodiscard]] StateBytes read_state_file(const std::filesystem::path& file, std::span<std::uint8_t> into);

/// Renames a file whose content is not used with the suffix ".rejected". Returns an empty string, or what failed.
[[nodiscard]] std::string set_state_file_aside(const std::filesystem::path& file);

/// Temporary file in the same folder, write, fsync, rename, fsync of the folder. Returns an empty string, or the failed
/// operation; the old file is then unchanged. Blocks as long as the medium needs.
[[nodiscard]] std::string write_state_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace boresight::runtime
