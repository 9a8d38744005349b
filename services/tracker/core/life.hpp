// When a track is confirmed, and when it is given up.
#pragma once

#include "services/tracker/core/rules_config.hpp"
#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// Takes a scan that showed the object, or could have: its history, its existence, and whether it is confirmed by now.
/// `wait_s`: age until which it is not confirmed, as it may be another one's image (images.hpp) or piece (pieces.hpp).
void count_scan(TrackedObject& track, const RulesConfig& config, double wait_s);

/// Whether it was missed too often or for too long, can no longer be confirmed, or is not a number any more.
[[nodiscard]] bool is_dead(const TrackedObject& track, const RulesConfig& config);

}  // namespace boresight::tracking
