// When a track is confirmed, and when it is given up.
#pragma once

#include "services/tracker/core/config.hpp"
#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// Takes a scan that showed the object, or could have: its history, its existence, and whether it is confirmed by now.
/// `may_be_image`: of another track (images.hpp), so that it has to wait.
void count_scan(TrackedObject& track, const Config& config, bool may_be_image);

/// Whether it was missed too often or for too long, can no longer be confirmed, or is not a number any more.
[[nodiscard]] bool is_dead(const TrackedObject& track, const Config& config);

}  // namespace boresight::tracking
