// Which vehicle of a configuration folder is chosen, and where the examples are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace boresight::runtime {

/// Sorted names of the vehicle files (*.toml) in `folder`, without suffix; none if there is no such folder.
[[nodiscard]] std::vector<std::string> vehicle_names(const std::filesystem::path& folder);

/// The chosen vehicle's file: the target of the link DIR/vehicle.toml, else the only file in DIR/vehicle. Throws
/// config::Error, which says how to choose, if there is neither.
[[nodiscard]] std::filesystem::path chosen_vehicle_file(const std::filesystem::path& directory);

/// Makes DIR/vehicle/NAME.toml the chosen vehicle by one rename of the link DIR/vehicle.toml: a service that starts
/// meanwhile finds the one or the other. The file must exist. Throws std::runtime_error with the place and the cause.
void choose_vehicle(const std::filesystem::path& directory, const std::string& name);

/// Folder of the example vehicles of an installed tool: PREFIX/share/boresight/vehicle for a program in PREFIX/bin.
/// Empty if there is none, and for services, which use their configuration folder only.
[[nodiscard]] std::filesystem::path example_vehicle_folder();
/// The same for a program in the folder `binaries`.
[[nodiscard]] std::filesystem::path example_vehicle_folder(const std::filesystem::path& binaries);

}  // namespace boresight::runtime
