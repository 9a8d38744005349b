// A vehicle as a file for the services.
#pragma once

#include <string>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::simulator {

/// The format is that of config/schema/vehicle.md, with radars of profile ARS548 over UDP and ego signals of profile
/// Toyota.
[[nodiscard]] std::string vehicle_toml(const VehicleConfig& vehicle);

}  // namespace boresight::simulator
