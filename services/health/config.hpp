// config/services/health.toml
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/health/core/config.hpp"
#include "services/health/dds/config.hpp"

namespace boresight::health {

struct FileConfig {
  Config supervision;
  dds::Config dds;
};

/// Throws config::Error. BORESIGHT_DDS_DOMAIN in the environment takes precedence over the file's domain.
[[nodiscard]] FileConfig read_config(config::Reader root);

/// BORESIGHT_DDS_DOMAIN of the environment, or `fallback`. Throws config::Error if it is no number from 0 to 232.
[[nodiscard]] std::uint32_t domain_from_environment(std::uint32_t fallback);

}  // namespace boresight::health
