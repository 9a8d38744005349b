// Two tracks on one object.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "services/tracker/core/rules_config.hpp"
#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// Leaves one track of those that are of one object, as a radar at `sensor_m` sees it: the older one, or the confirmed
/// one, whose box grows to where the other one's was.
void remove_duplicates(std::vector<TrackedObject>& tracks, const Eigen::Vector2d& sensor_m, const RulesConfig& config);

}  // namespace boresight::tracking
