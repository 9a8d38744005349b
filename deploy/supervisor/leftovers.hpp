// Files that a killed iceoryx domain leaves behind, and signs of a running domain.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace boresight::supervisor {

/// Folders of iceoryx's files; different only in tests.
struct Places {
  std::filesystem::path shared_memory = "/dev/shm";
  std::filesystem::path sockets = "/tmp";
};

/// The reason why RouDi must not be started here, or nothing. A running RouDi holds a lock on
/// <sockets>/iox-unique-roudi.lock while it lives.
[[nodiscard]] std::optional<std::string> running_roudi(const Places& places);

/// Identity of the management memory, which changes when another RouDi recreates it; 0 if there is none.
[[nodiscard]] ino_t management_inode(const Places& places);

/// Names of the shared memories that RouDi reserved, from its output.
[[nodiscard]] std::vector<std::string> reserved_segments(const std::string& roudi_output);

/// Every file that a domain of these segments and runtime names may leave behind.
[[nodiscard]] std::vector<std::filesystem::path> leftovers(const Places& places,
                                                           const std::vector<std::string>& segments,
                                                           const std::vector<std::string>& runtime_names);

}  // namespace boresight::supervisor
