// A vehicle as the file that the services read.
#pragma once

#include <string>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::simulator {

/// As config/schema/vehicle.md has it: radars of the profile ARS548 over UDP and ego signals of the profile Toyota.
[[nodiscard]] std::string vehicle_toml(const VehicleConfig& vehicle);

}  // namespace boresight::simulator
