// config/services/tracker.toml → tracking::Config.
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/tracker/core/config.hpp"

namespace boresight::tracking {

/// Reads the document; throws config::Error.
[[nodiscard]] Config read_config(config::Reader root);

}  // namespace boresight::tracking
