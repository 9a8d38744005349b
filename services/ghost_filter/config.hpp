// config/services/ghost_filter.toml → ghosts::Config.
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/ghost_filter/core/config.hpp"

namespace boresight::ghosts {

/// Reads the document; throws config::Error.
[[nodiscard]] Config read_config(config::Reader root);

}  // namespace boresight::ghosts
