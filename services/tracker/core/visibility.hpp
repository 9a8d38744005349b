// Whether a scan could have shown an object: only then it is a miss that it did not.
#pragma once

#include <span>

#include "interfaces/messages/corrected_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// Within the radar's field of view, with a range rate over ground of at least `blind_range_rate_mps`, and not behind
/// another of the tracks that is a vehicle and surely there.
[[nodiscard]] bool can_see(const RadarConfig& radar, const ScanGeometry& geometry, const TrackedObject& track,
                           std::span<const TrackedObject> tracks, double blind_range_rate_mps);

}  // namespace boresight::tracking
