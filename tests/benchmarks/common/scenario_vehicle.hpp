// The vehicle of a scenario, from the configuration of the source tree.
#pragma once

#include <filesystem>
#include <string>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/scenario.hpp"

namespace boresight::bench {

/// The vehicle that a scenario names, or the demo vehicle. Throws config::Error.
[[nodiscard]] inline VehicleConfig vehicle_of(const simulator::Scenario& scenario) {
  const std::string name = scenario.vehicle.empty() ? "demo" : scenario.vehicle;
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle" / (name + ".toml"));
}

}  // namespace boresight::bench
