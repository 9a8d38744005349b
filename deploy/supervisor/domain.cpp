#include "deploy/supervisor/domain.hpp"

#include <unistd.h>

#include "interfaces/catalogue/catalogue.hpp"

namespace boresight::supervisor {

std::filesystem::path binaries_folder() {
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string probe = "boresight-" + std::string(catalogue::name_of(catalogue::Service::kTracker));
  if (std::filesystem::exists(own / probe)) return own;
  return own.parent_path() / "lib" / "boresight";
}

DomainConfig domain_of_catalogue(const DomainOptions& options, const std::filesystem::path& pools_file) {
  DomainConfig config;
  // Monitoring off: it would remove a live service that got no processor time for 1.5 s.
  config.roudi.arguments = {
      (options.binaries / "boresight-roudi").string(), "iox-roudi", "-m", "off", "-k", "1", "-c", pools_file.string()};
  config.run_directory = options.run_directory;
  config.log_directory = options.log_directory;
  config.config_directory = options.config_directory;
  for (std::size_t i = 0; i < catalogue::kNumberOfSupervisedServices; ++i) {
    const std::string name(catalogue::kServiceNames[i]);
    ProcessSpec spec;
    spec.name = name;
    spec.runtime_name = "boresight-" + name;
    spec.is_on_data_path = catalogue::is_on_data_path(static_cast<catalogue::Service>(i));
    spec.command.arguments = {(options.binaries / spec.runtime_name).string(), "--config",
                              options.config_directory.string()};
    if (!options.vehicle.empty()) {
      spec.command.arguments.insert(spec.command.arguments.end(), {"--vehicle", options.vehicle});
    }
    spec.command.environment = options.environment;
    spec.command.environment.emplace_back("BORESIGHT_RUNTIME_DIR",
                                          std::filesystem::absolute(options.run_directory).string());
    config.services.push_back(std::move(spec));
  }
  return config;
}

std::optional<std::string> shared_memory_shortage(std::size_t needed_bytes,
                                                  const std::filesystem::path& shared_memory) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(shared_memory, error);
  if (error) return shared_memory.string() + ": " + error.message();
  if (space.available >= needed_bytes) return std::nullopt;
  constexpr std::size_t kMebibyte = 1024 * 1024;
  return shared_memory.string() + " has " + std::to_string(space.available / kMebibyte) + " MiB free, " +
         std::to_string(needed_bytes / kMebibyte + 1) + " MiB are needed (in a container, see --shm-size)";
}

std::filesystem::path unused_run_directory(const std::filesystem::path& folder) {
  const std::string name = "boresight-" + std::to_string(getuid()) + "-" + std::to_string(getpid());
  std::filesystem::path directory = folder / name;
  std::error_code ignored;
  for (int n = 2; std::filesystem::exists(directory, ignored); ++n)
    directory = folder / (name + "-" + std::to_string(n));
  return directory;
}

}  // namespace boresight::supervisor
