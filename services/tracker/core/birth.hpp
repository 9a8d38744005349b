// What a new track begins with: where its cluster is seen, its range rate, and how the road runs.
#pragma once

#include <Eigen/Core>

#include "services/tracker/core/clusters.hpp"
#include "services/tracker/core/own_road.hpp"
#include "services/tracker/core/rules_config.hpp"
#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// A tentative track, without an id, of what a cluster is seen of. The range rate tells the speed along the line of
/// sight, and nothing how fast it goes across; but what is far away on the own road most likely drives along it.
/// `sensor_m` is where the scan was taken from, vehicle frame.
[[nodiscard]] TrackedObject new_track(const Cluster& cluster, const Eigen::Vector2d& sensor_m, bool has_elevation,
                                      const OwnRoad& road, const RulesConfig& config);

}  // namespace boresight::tracking
