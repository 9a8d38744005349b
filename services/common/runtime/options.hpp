// The options --config and --vehicle, which every program has.
#pragma once

#include <filesystem>
#include <string>

#include "interfaces/catalogue/catalogue.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/common/runtime/vehicle_choice.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace boresight::runtime {

/// The folder of the configuration where --config does not name one: config/ of the source tree if this program runs
/// from a build tree, /etc/boresight if it is installed.
[[nodiscard]] std::filesystem::path default_config_folder();
/// The same for a program in the folder `binaries`. A build tree is the parent of `binaries` with a CMakeCache.txt in
/// it.
[[nodiscard]] std::filesystem::path default_config_folder(const std::filesystem::path& binaries);

/// Where a process finds its configuration, and which vehicle it is for.
struct Configuration {
  std::filesystem::path directory = default_config_folder();  ///< --config DIR: holds vehicle/ and services/
  std::string vehicle_name;                                   ///< --vehicle NAME|FILE; empty: the chosen vehicle
  std::string statistics;  ///< of all radars, whatever the vehicle file says; empty: as it says
  std::filesystem::path examples = example_vehicle_folder();  ///< further vehicles that have a name; empty: none

  /// DIR/services/<name>.toml.
  [[nodiscard]] std::filesystem::path service_file(std::string_view name) const;
  /// The file of a radar profile: DIR/radar_profiles/<name>.toml, or `name` itself if it holds a '/' or ends in
  /// ".toml".
  [[nodiscard]] std::filesystem::path radar_profile_file(const std::string& name) const;
  /// The vehicle's file: `vehicle_name` itself if it is a path to a file, else DIR/vehicle/<vehicle_name>.toml, else
  /// the example of that name; chosen_vehicle_file() if the name is empty. Throws config::Error, which lists the names,
  /// if there is no such file.
  [[nodiscard]] std::filesystem::path vehicle_file() const;
  /// Reads and checks the vehicle file; throws config::Error.
  [[nodiscard]] VehicleConfig vehicle(config::VehicleUse use = config::VehicleUse::kLive) const;
};

/// Adds --config DIR; given twice, the last one counts. `configuration` must outlive `app`.
CLI::Option* add_config_option(CLI::App& app, Configuration& configuration);
/// Adds --vehicle NAME|FILE; given twice, the last one counts. `about` replaces the usual description.
CLI::Option* add_vehicle_option(CLI::App& app, Configuration& configuration, const std::string& about = {});

}  // namespace boresight::runtime
