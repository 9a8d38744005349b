// All mapping files that a vehicle file names.
#pragma once

#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/core/mappings.hpp"

namespace boresight::ingest {

/// Throws config::Error with a line for each error of the first file that has any.
[[nodiscard]] Mappings read_mappings(const VehicleConfig& vehicle);

}  // namespace boresight::ingest
