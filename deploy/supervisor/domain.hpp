// The domain of the catalogue: which processes, with which command lines, on which memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deploy/supervisor/supervisor.hpp"

namespace boresight::supervisor {

struct DomainOptions {
  std::filesystem::path binaries;  ///< folder of boresight-<service>; see binaries_folder()
  std::filesystem::path config_directory;
  std::string vehicle;  ///< empty: the only one there is
  std::filesystem::path run_directory;
  std::filesystem::path log_directory;
  std::vector<std::pair<std::string, std::string>> environment;  ///< for every service
};

/// Folder of the services' binaries beside the running program: its own folder in a build tree,
/// ../lib/boresight when installed.
[[nodiscard]] std::filesystem::path binaries_folder();

/// RouDi with `pools_file` (written from the catalogue, one segment) and every supervised service. Creates nothing.
[[nodiscard]] DomainConfig domain_of_catalogue(const DomainOptions& options, const std::filesystem::path& pools_file);

/// Why a domain that needs so many bytes of shared memory cannot be started, or nothing. Without room, the first
/// process to touch a missing page would die of SIGBUS: containers often have 64 MiB only.
[[nodiscard]] std::optional<std::string> shared_memory_shortage(std::size_t needed_bytes,
                                                                const std::filesystem::path& shared_memory);

/// A short path for a run directory of this process alone; not created. What a killed process of the same number (in a
/// container, numbers are soon the same) left behind is not taken for one's own.
[[nodiscard]] std::filesystem::path unused_run_directory(const std::filesystem::path& folder = "/tmp");

}  // namespace boresight::supervisor
