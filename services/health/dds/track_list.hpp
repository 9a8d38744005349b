// A track list as DDS type.
#pragma once

#include <cstdint>
#include <string>

#include "generated/track_list.h"
#include "interfaces/messages/track_list.hpp"

namespace boresight::dds {

/// Replaces the content of `out`, whose memory is used again: after the first list of kMaxTracks tracks, nothing is
/// allocated. `time_ns` is the measurement time since the epoch.
void fill(perception::TrackList& out, const TrackList& list, const std::string& vehicle_name, std::int64_t time_ns);

}  // namespace boresight::dds
