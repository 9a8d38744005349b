// The settings files of the services, read as the services do.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "services/boresight/run/chain.hpp"
#include "services/common/runtime/options.hpp"

namespace boresight::run {

/// Throws config::Error.
[[nodiscard]] Settings read_settings(const runtime::Configuration& configuration, const VehicleConfig& vehicle);

/// Name and file of each: the services, and the classes of objects that they share.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> settings_files(
    const runtime::Configuration& configuration);

}  // namespace boresight::run
