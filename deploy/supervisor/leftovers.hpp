// Files that a killed iceoryx domain leaves behind, and signs of a running domain.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace boresight::supervisor {

/// RouDi's shared memory for queues, reference counters and ports; a fixed name of iceoryx.
inline constexpr std::string_view kManagementSegment = "iceoryx_mgmt";

/// Folders of iceoryx's files; different only in tests.
struct Places {
  std::filesystem::path shared_memory = "/dev/shm";
  std::filesystem::path sockets = "/tmp";
};

/// The reason why RouDi must not be started here, or nothing. A running RouDi holds a lock on
/// <sockets>/iox-unique-roudi.lock while it lives.
[[nodiscard]] std::optional<std::string> running_roudi(const Places& places);

/// Waits until no RouDi holds the lock, but not longer than the end of a killed RouDi takes, which unmaps its memory.
void wait_for_end_of_roudi(const Places& places);

/// Identities of shared memories, which change when another RouDi recreates them; 0 for one that does not exist.
[[nodiscard]] std::vector<ino_t> segment_inodes(const Places& places, const std::vector<std::string>& segments);

/// Names of the shared memories that RouDi reserved, from its output.
[[nodiscard]] std::vector<std::string> reserved_segments(const std::string& roudi_output);

/// Every file that a domain of these segments and runtime names may leave behind.
[[nodiscard]] std::vector<std::filesystem::path> leftovers(const Places& places,
                                                           const std::vector<std::string>& segments,
                                                           const std::vector<std::string>& runtime_names);

}  // namespace boresight::supervisor
