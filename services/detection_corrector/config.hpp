// config/services/detection_corrector.toml → corrector::Config.
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/detection_corrector/core/config.hpp"

namespace boresight::corrector {

/// Reads the document; throws config::Error.
[[nodiscard]] Config read_config(config::Reader root);

}  // namespace boresight::corrector
