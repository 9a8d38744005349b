// Tracks that lie where a mirror that nobody knows of would show another one.
#pragma once

#include <span>

#include <Eigen/Core>

#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// By what a track may be another one's image: no known way, some mirror, or the side of a third one.
enum class ImageOf { kNothing, kAny, kSide };

/// Whether another track, as old as it, would be seen so by way of some mirror: over a detour, weaker, and moving alike
/// as seen from the sensor; and whether the side of a third would be that mirror. Of what has no strength it is not
/// known. Vehicle frame.
[[nodiscard]] ImageOf image_of(const TrackedObject& track, std::span<const TrackedObject> tracks,
                               const Eigen::Vector2d& sensor_m);

}  // namespace boresight::tracking
