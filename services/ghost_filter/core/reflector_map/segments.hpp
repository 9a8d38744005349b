// The reflectors as the classified scan publishes them: straight segments in the vehicle frame.
#pragma once

#include <span>

#include "interfaces/messages/classified_scan.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"
#include "services/ghost_filter/core/reflector_map/reflector.hpp"

namespace boresight::ghosts {

/// Of those that are likelier there than not, each stretch without an opening; arcs as chords. Where the message has no
/// room for all, those that most detections lie on are published. At most kMaxReflectorSegments reflectors are taken.
void write_segments(std::span<const Reflector> reflectors, const Odometry& odometry, ClassifiedScan& out);

}  // namespace boresight::ghosts
