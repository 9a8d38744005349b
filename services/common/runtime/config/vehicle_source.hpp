// Where a radar or the ego signals come from: table `source` of a vehicle file, and what two radars cannot share.
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::config {

/// Reads the table and notes errors; addresses, names and versions of IP are checked (config/schema/vehicle.md).
[[nodiscard]] SourceAddress read_source(Reader reader);

/// True if frames of one source would be taken for both radars.
[[nodiscard]] bool is_same_source(const RadarConfig& a, const RadarConfig& b);

/// True for a copied pose: positions within a centimetre and directions within a degree. Radars are larger.
[[nodiscard]] bool is_same_pose(const MountingPose& a, const MountingPose& b);

}  // namespace boresight::config
