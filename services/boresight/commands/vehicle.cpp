// `boresight vehicle`: lists the vehicles of a configuration folder and chooses the one that the services run with.
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/config/read_text.hpp"
#include "services/ghost_filter/weights_file.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"

namespace boresight {

namespace {

namespace fs = std::filesystem;

/// What every service checks of the vehicle: its keys, its mapping files, and the weights of its radars' profiles.
VehicleConfig checked_vehicle(const runtime::Configuration& configuration, const fs::path& place,
                              config::Reader document) {
  VehicleConfig vehicle = config::read_vehicle_at(place, std::move(document));
  static_cast<void>(ingest::read_mappings(vehicle));
  for (const RadarConfig& radar : vehicle.radars) {
    static_cast<void>(ghosts::read_weights(configuration.radar_profile_file(radar.statistics)));
  }
  return vehicle;
}

int use_vehicle(const runtime::Configuration& configuration) {
  const fs::path folder = configuration.directory / "vehicle", source = configuration.vehicle_file();
  const std::string name = source.stem().string();
  const fs::path place = folder / (name + ".toml");
  const std::string text = config::read_text(source);
  const VehicleConfig vehicle = checked_vehicle(configuration, place, config::Reader::parse(text, source.string()));
  std::error_code error;
  if (!fs::exists(place, error)) {
    terminal::write_file(place, text);
    // Each service has its own user, whatever the umask of this one is.
    using fs::perms;
    fs::permissions(place, perms::owner_read | perms::owner_write | perms::group_read | perms::others_read, error);
  } else if (config::read_text(place) != text) {
    throw UsageError(fmt::format("{} differs from {}; remove it, or give the new file another name", place.string(),
                                 source.string()));
  }
  runtime::choose_vehicle(configuration.directory, name);
  terminal::print(fmt::format("vehicle {}: {}, {} radar{}\nIt is used from the next start of the services on.\n", name,
                              place.string(), vehicle.radars.size(), vehicle.radars.size() == 1 ? "" : "s"));
  return exit_code::kSuccess;
}

/// The file of the chosen vehicle; empty if none is chosen.
fs::path chosen_or_none(const fs::path& directory) {
  try {
    return runtime::chosen_vehicle_file(directory);
  } catch (const config::Error&) {
    return {};
  }
}

int list_vehicles(const runtime::Configuration& configuration) {
  const fs::path folder = configuration.directory / "vehicle", chosen = chosen_or_none(configuration.directory);
  std::string text;
  for (const fs::path& place : {folder, configuration.examples}) {
    if (place.empty()) continue;
    for (const std::string& name : runtime::vehicle_names(place)) {
      const fs::path file = place / (name + ".toml");
      text += fmt::format("{} {:<24} {}\n", file == chosen ? "*" : " ", name, file.string());
    }
  }
  if (text.empty()) throw config::Error(fmt::format("{}: holds no vehicle", folder.string()));
  terminal::print(text + (chosen.empty() ? "No vehicle is chosen.\n" : "* is chosen\n"));
  return exit_code::kSuccess;
}

}  // namespace

void add_vehicle_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "vehicle", "Lists the vehicles of a configuration folder, or chooses the one of the services.");
  command->require_subcommand(1);
  command->footer("'boresight vehicle list --help' and 'boresight vehicle use --help' list the options.");
  const auto options = std::make_shared<runtime::Configuration>();

  CLI::App* const list =
      command->add_subcommand("list", "Lists the vehicles with a name; a star marks the chosen one.");
  runtime::add_config_option(*list, *options);
  on_call(
      *list, exit_code, {"vehicle list", "the list is printed", ""}, [options] { return list_vehicles(*options); },
      options.get());

  CLI::App* const use = command->add_subcommand(
      "use", "Checks a vehicle file, copies it into the configuration folder, and makes it the chosen one.");
  use->add_option("vehicle", options->vehicle_name, "A name that 'boresight vehicle list' lists, or a file")
      ->type_name("NAME|FILE")
      ->required();
  runtime::add_config_option(*use, *options);
  on_call(
      *use, exit_code, {"vehicle use demo\nvehicle use ./my_car.toml", "the vehicle is chosen", ""},
      [options] { return use_vehicle(*options); }, options.get());
}

}  // namespace boresight
