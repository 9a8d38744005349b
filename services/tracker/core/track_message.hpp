// A track as the message has it.
#pragma once

#include "interfaces/messages/track_list.hpp"
#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// Writes every field. Slower than `stopped_speed_mps` it is called stopped.
void write_track(const TrackedObject& track, double stopped_speed_mps, Track& out);

}  // namespace boresight::tracking
