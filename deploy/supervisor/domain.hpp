// The catalogue's domain: its processes, their command lines and the required shared memory.
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
  std::string vehicle;  ///< empty: the only vehicle file
  std::filesystem::path run_directory;
  std::filesystem::path log_directory;
  std::vector<std::pair<std::string, std::string>> environment;  ///< for every service
};

/// Folder of the services' binaries beside the running program: its own folder in a build tree,
/// ../lib/boresight when installed.
[[nodiscard]] std::filesystem::path binaries_folder();

/// RouDi with `pools_file` (written from the catalogue, one segment) and every supervised service. Creates nothing.
[[nodiscard]] DomainConfig domain_of_catalogue(const DomainOptions& options, const std::filesystem::path& pools_file);

/// The reason why a domain cannot start with the free shared memory, or nothing. Without enough memory, the first
/// process to touch a missing page dies of SIGBUS. Containers often have only 64 MiB.
[[nodiscard]] std::optional<std::string> shared_memory_shortage(std::size_t needed_bytes,
                                                                const std::filesystem::path& shared_memory);

/// A short path for a run directory of this process only; not created. The path does not exist yet, so that files of a
/// killed process with the same id are not used. In containers, ids repeat often.
[[nodiscard]] std::filesystem::path unused_run_directory(const std::filesystem::path& folder = "/tmp");

}  // namespace boresight::supervisor
