// Scenarios as TOML files that a user can write; the shipped ones (config/scenarios/) are part of the program as well.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/common/runtime/config/reader.hpp"
#include "tests/simulator/scenario.hpp"

namespace boresight::simulator {

/// Reads the open document; throws config::Error with every problem found, each with file, line, key and what is
/// allowed. config/schema/scenario.md tells every key.
[[nodiscard]] Scenario read_scenario(config::Reader root);

/// A shipped scenario by its name, or one of the user's by its file: what contains a '/' or ends in ".toml" is a file.
/// Throws config::Error for a file that cannot be read or is wrong, std::invalid_argument that lists the shipped ones
/// for an unknown name.
[[nodiscard]] Scenario scenario(std::string_view name_or_file);
/// Names of the shipped ones, sorted.
[[nodiscard]] std::vector<std::string> scenario_names();

}  // namespace boresight::simulator
