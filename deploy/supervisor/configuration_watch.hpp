// Notices a change of any configuration file.
#pragma once

#include <cstdint>
#include <filesystem>

namespace boresight::supervisor {

/// A number that changes when a file below the folder is written, added, removed or renamed: made from paths, sizes and
/// times of modification. An unreadable or missing folder has a number, too.
[[nodiscard]] std::uint64_t fingerprint_of(const std::filesystem::path& folder);

}  // namespace boresight::supervisor
