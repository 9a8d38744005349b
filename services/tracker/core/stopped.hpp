// What came to a stand is no longer detected as moving, but it is where it was.
#pragma once

#include <span>

#include "interfaces/messages/classified_scan.hpp"
#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

inline constexpr double kSlow_mps = 0.7;  ///< a vehicle that is about to stand

/// Keeps confirmed tracks that were slow when last detected, as long as the scan shows something that stands in their
/// box and is no reflector's: they come to rest there.
void keep_stopped(std::span<TrackedObject> tracks, const ClassifiedScan& scan);

}  // namespace boresight::tracking
