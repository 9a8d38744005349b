// The text of a configuration file, read without waiting for anything and without boundless memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace boresight::config {

/// Capacity of a TOML file: a hundred times the largest shipped one.
inline constexpr std::size_t kMaxConfigurationBytes = std::size_t{4} << 20;
/// Capacity of a DBC file: the databases of whole vehicles have some 10 MB.
inline constexpr std::size_t kMaxDatabaseBytes = std::size_t{64} << 20;

/// The content of a regular file of at most `max_bytes` bytes. Throws Error, which names the file and the reason, if
/// the file is absent, is no regular file (a folder, pipe, socket or device), is larger, or cannot be read.
[[nodiscard]] std::string read_text(const std::filesystem::path& file, std::size_t max_bytes = kMaxConfigurationBytes);

}  // namespace boresight::config
