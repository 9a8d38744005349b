// config/services/tracker.toml, object_classes.toml and object_forest.csv → tracking::Config.
#pragma once

#include <filesystem>

#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/options.hpp"
#include "services/tracker/core/config.hpp"

namespace boresight::tracking {

/// Reads tracker.toml; throws config::Error. The classes are the defaults, and the forest has no trees.
[[nodiscard]] Config read_config(config::Reader root);
/// The file of the forest of the classes.
[[nodiscard]] std::filesystem::path forest_file(const runtime::Configuration& files);
/// Reads the forest of the classes; throws config::Error, which names file and line.
[[nodiscard]] ObjectForest read_forest(const std::filesystem::path& file);
/// Reads the three files of the folder; throws config::Error.
[[nodiscard]] Config read_config(const runtime::Configuration& files);

}  // namespace boresight::tracking
