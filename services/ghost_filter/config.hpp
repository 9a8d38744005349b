// config/services/ghost_filter.toml and the radars' profiles → ghosts::Config.
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/options.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ghost_filter/core/config.hpp"

namespace boresight::ghosts {

/// Reads the document, which holds no weights; throws config::Error.
[[nodiscard]] Config read_settings(config::Reader root);

/// With the weights of each radar's profile; throws config::Error.
[[nodiscard]] Config read_config(const runtime::Configuration& files, const VehicleConfig& vehicle);

}  // namespace boresight::ghosts
