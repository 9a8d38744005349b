#include "services/common/runtime/options.hpp"

#include <fstream>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/common/text/near_names.hpp"

namespace boresight::runtime {

namespace {

namespace fs = std::filesystem;

constexpr const char* kInstalledConfiguration = "/etc/boresight";

bool is_config_folder(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "vehicle", ignored) && fs::is_directory(folder / "services", ignored);
}

/// The source tree that CMake noted in its cache; empty if there is none.
fs::path source_of(std::ifstream& cache) {
  constexpr std::string_view kKey = "CMAKE_HOME_DIRECTORY:INTERNAL=";
  for (std::string line; std::getline(cache, line);) {
    if (line.starts_with(kKey)) return line.substr(kKey.size());
  }
  return {};
}

/// "in FOLDER", and in the examples' folder if there is one.
std::string places_of(const fs::path& folder, const fs::path& examples) {
  return examples.empty() ? folder.string() : fmt::format("{} and {}", folder.string(), examples.string());
}

}  // namespace

fs::path default_config_folder(const fs::path& binaries) {
  const fs::path build = binaries.parent_path();
  if (std::ifstream cache(build / "CMakeCache.txt"); cache) {
    // Beside the build tree first: a checkout that was moved has an old path in its cache.
    for (const fs::path& source : {build.parent_path(), source_of(cache)}) {
      if (!source.empty() && is_config_folder(source / "config")) return source / "config";
    }
  }
  return kInstalledConfiguration;
}

fs::path default_config_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path(kInstalledConfiguration) : default_config_folder(program.parent_path());
}

fs::path Configuration::service_file(std::string_view name) const {
  return directory / "services" / fmt::format("{}.toml", name);
}

fs::path Configuration::radar_profile_file(const std::string& name) const {
  if (name.find('/') != std::string::npos || name.ends_with(".toml")) return name;
  return directory / "radar_profiles" / fmt::format("{}.toml", name);
}

fs::path Configuration::vehicle_file() const {
  if (vehicle_name.empty()) return chosen_vehicle_file(directory);
  const fs::path folder = directory / "vehicle";
  std::error_code ignored;
  const bool is_path = vehicle_name.find('/') != std::string::npos;
  for (const fs::path& place : {folder, examples}) {
    const fs::path file = place / (vehicle_name + ".toml");
    if (!is_path && !place.empty() && fs::exists(fs::symlink_status(file, ignored))) return file;
  }
  // A path may also name a pipe or a folder: the reader says so.
  if (is_path ? fs::exists(vehicle_name, ignored) : fs::is_regular_file(vehicle_name, ignored)) return vehicle_name;
  if (is_path) throw config::Error(fmt::format("--vehicle {}: no such file", vehicle_name));
  std::vector<std::string> names = vehicle_names(folder);
  if (!examples.empty()) {
    const std::vector<std::string> more = vehicle_names(examples);
    names.insert(names.end(), more.begin(), more.end());
  }
  const std::vector<std::string> near = near_names(vehicle_name, names);
  throw config::Error(fmt::format("no vehicle '{}' in {}{} --vehicle takes a file or one of the names there: {}",
                                  vehicle_name, places_of(folder, examples),
                                  near.empty() ? "." : fmt::format("; did you mean '{}'?", near.front()),
                                  names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

VehicleConfig Configuration::vehicle(config::VehicleUse use) const {
  VehicleConfig vehicle = config::read_vehicle_file(vehicle_file(), use);
  if (!statistics.empty()) {
    for (RadarConfig& radar : vehicle.radars) radar.statistics = statistics;
  }
  return vehicle;
}

CLI::Option* add_config_option(CLI::App& app, Configuration& configuration) {
  return app
      .add_option_function<std::string>(
          "--config",
          [&configuration](const std::string& folder) {
            std::error_code ignored;
            if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored)) {
              throw CLI::ValidationError("--config",
                                         folder + " is a file; give the folder that holds vehicle/ and services/");
            }
            configuration.directory = folder;
          },
          "Folder with vehicle/ and services/")
      ->type_name("DIR")
      ->default_str(configuration.directory.string())
      ->take_last();
}

CLI::Option* add_vehicle_option(CLI::App& app, Configuration& configuration, const std::string& about) {
  return app
      .add_option("--vehicle", configuration.vehicle_name,
                  about.empty() ? "Vehicle: a name in the folder vehicle/, or a file" : about)
      ->type_name("NAME|FILE")
      ->take_last();
}

}  // namespace boresight::runtime
