// config/vehicle/*.toml → VehicleConfig.
#pragma once

#include <filesystem>

#include "services/common/runtime/config/reader.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::config {

/// Reads the open document; throws Error with every problem found (see config/schema/vehicle.md).
[[nodiscard]] VehicleConfig read_vehicle(Reader root);
[[nodiscard]] VehicleConfig read_vehicle_file(const std::filesystem::path& file);

}  // namespace boresight::config
