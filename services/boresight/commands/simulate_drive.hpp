// Writes a simulated drive, for `boresight simulate` and `boresight demo`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/scenario_file.hpp"

namespace boresight {

/// Simulates with a progress bar and writes the recordings and the truth into `folder`; they get their places there
/// when all of them are complete. Returns lines that describe the drive and name the files. Throws Interrupted,
/// std::invalid_argument if the vehicle does not fit the scenario, and terminal::OutputError.
[[nodiscard]] std::string write_simulated_drive(const simulator::Scenario& scenario, const VehicleConfig& vehicle,
                                                std::uint64_t seed, double duration_s,
                                                const std::filesystem::path& folder);

}  // namespace boresight
