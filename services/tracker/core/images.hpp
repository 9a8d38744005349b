// Tracks that lie where a mirror that nobody knows of would show another one.
#pragma once

#include <span>

#include <Eigen/Core>

#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// Whether another track, as old as this one, would be seen so by way of some mirror: over a detour, weaker, and moving
/// alike as seen from the sensor. Of what has no strength it is not known. Vehicle frame.
[[nodiscard]] bool may_be_image(const TrackedObject& track, std::span<const TrackedObject> tracks,
                                const Eigen::Vector2d& sensor_m);

}  // namespace boresight::tracking
