// config/services/alignment_estimator.toml → alignment::Config.
#pragma once

#include "services/alignment_estimator/core/config.hpp"
#include "services/common/runtime/config/reader.hpp"

namespace boresight::alignment {

/// Reads the document; throws config::Error.
[[nodiscard]] Config read_config(config::Reader root);

}  // namespace boresight::alignment
