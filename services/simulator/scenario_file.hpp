// Scenarios as TOML files that a user can write. The shipped scenarios (config/scenarios/) are built into the program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/common/runtime/config/reader.hpp"
#include "services/simulator/scenario.hpp"

namespace boresight::simulator {

/// Reads the open document. Throws config::Error with every problem found, each with file, line, key and the allowed
/// values. config/schema/scenario.md lists all keys.
[[nodiscard]] Scenario read_scenario(config::Reader root);

/// A shipped scenario by its name, or a user's scenario by its file. An argument that contains a '/' or ends in ".toml"
/// is a file. Throws config::Error for a file that cannot be read or is wrong. For an unknown name it throws
/// std::invalid_argument, which lists the shipped scenarios.
[[nodiscard]] Scenario scenario(std::string_view name_or_file);
/// Names of the shipped scenarios, sorted.
[[nodiscard]] std::vector<std::string> scenario_names();

}  // namespace boresight::simulator
