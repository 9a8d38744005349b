// config/services/tracker.toml and object_classes.toml → tracking::Config.
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/options.hpp"
#include "services/tracker/core/config.hpp"

namespace boresight::tracking {

/// Reads tracker.toml; throws config::Error. The classes are the defaults.
[[nodiscard]] Config read_config(config::Reader root);
/// Reads both files of the folder; throws config::Error.
[[nodiscard]] Config read_config(const runtime::Configuration& files);

}  // namespace boresight::tracking
