// Writes the result of a static calibration into the memory file from which the alignment estimator starts.
#pragma once

#include <filesystem>
#include <string>

#include "services/alignment_estimator/core/plate/seed.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::calibrate {

/// Writes the seed into the estimator's memory file; the entries of other radars and of the speed signal stay. A
/// missing file is created with every other radar at its nominal mounting. A file that is damaged or belongs to another
/// vehicle is renamed, as the estimator does, and replaced. The service must not run, because it would overwrite the
/// file. Returns a note for the user, or ""; throws std::runtime_error if the file cannot be read or written.
[[nodiscard]] std::string seed_state_file(const std::filesystem::path& file, const VehicleConfig& vehicle,
                                          const alignment::RotationSeed& seed);

}  // namespace boresight::calibrate
