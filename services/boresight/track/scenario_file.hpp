// The parameters of a simulated scenario (params.txt): the model of the tracker and the number of scans.
#pragma once

#include <cstddef>
#include <filesystem>

#include "services/tracker/core/model/linear_scenario.hpp"

namespace boresight::track {

struct ScenarioFile {
  tracking::LinearScenario model;
  std::size_t number_of_scans = 0;
};

/// Reads lines "key = value"; a value is a number or a matrix [a b;c d], '#' begins a comment line. Throws
/// config::Error with a line for each problem ("file:line: key: read …, allowed is …"), and recording::OpenError if the
/// file cannot be opened. Keys of the multi-target reference code that the tracker does not need (partitions, pruning)
/// are known and ignored; any other key is an error.
[[nodiscard]] ScenarioFile read_scenario_file(const std::filesystem::path& file);

}  // namespace boresight::track
