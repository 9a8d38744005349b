// Tracks that lie where a mirror that nobody knows of would show another one.
#pragma once

#include <span>

#include <Eigen/Core>

#include "services/tracker/core/rules_config.hpp"
#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// How old a track has to be to be confirmed, as another one, as old as it, would be seen so by way of some mirror:
/// over a detour, weaker, and moving alike as seen from the sensor; longer where the side of a third would be that
/// mirror. 0 if none would. Of what has no strength it is not known. Vehicle frame.
[[nodiscard]] double image_wait_s(const TrackedObject& track, std::span<const TrackedObject> tracks,
                                  const Eigen::Vector2d& sensor_m, const RulesConfig& config);

}  // namespace boresight::tracking
