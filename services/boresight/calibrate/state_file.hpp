// The seed's way into the file from which the alignment estimator starts.
#pragma once

#include <filesystem>
#include <string>

#include "services/alignment_estimator/core/plate/seed.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::calibrate {

/// Puts the seed into the estimator's memory file; what the file knows of the other radars and of the speed signal
/// stays. A missing file is begun, with every other radar at its nominal mounting; a file that is damaged or another
/// vehicle's is kept aside as the estimator does, and begun anew. The service must not be running: it would write its
/// own over it. Returns what is worth telling, or ""; throws std::runtime_error where the file cannot be read or
/// written.
[[nodiscard]] std::string seed_state_file(const std::filesystem::path& file, const VehicleConfig& vehicle,
                                          const alignment::RotationSeed& seed);

}  // namespace boresight::calibrate
