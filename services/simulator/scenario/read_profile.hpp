// Radar profiles as TOML files. The shipped profiles (config/radar_profiles/) are built into the program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/common/runtime/config/reader.hpp"
#include "services/simulator/radar/profile.hpp"
#include "services/simulator/scenario.hpp"

namespace boresight::simulator {

/// Reads the open document. Throws config::Error with every problem found. config/schema/radar_profile.md lists all
/// keys.
[[nodiscard]] radar::Profile read_profile(config::Reader root);

/// A shipped profile by its name, or a user's profile by its file. An argument that contains a '/' or ends in ".toml"
/// is a file. Throws config::Error for a file that cannot be read or is wrong. For an unknown name it throws
/// std::invalid_argument, which lists the shipped profiles.
[[nodiscard]] radar::Profile radar_profile(std::string_view name_or_file);
/// Names of the shipped profiles, sorted.
[[nodiscard]] std::vector<std::string> radar_profile_names();

/// Gives all radars of a scenario this profile, whatever the scenario says. Throws as radar_profile does.
void use_profile(Scenario& scenario, std::string_view name_or_file);

}  // namespace boresight::simulator
