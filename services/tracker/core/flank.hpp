// The line that is seen along the flank of a long vehicle.
#pragma once

#include <optional>

#include "services/tracker/core/clusters.hpp"
#include "services/tracker/core/heading.hpp"

namespace boresight::tracking {

/// What is seen along the flank of a long vehicle lies along its heading. Of the outline, that is the line on which the
/// most of it lies, within 0.5 rad of `heading_rad`, the heading that is known: what else is seen is of an end, of the
/// axles' far sides or a ghost, and lies behind it for a sensor at `sensor_m` (vehicle frame). Nothing if the line is
/// shorter than 5 m, or of fewer than three detections or a third of them, or has over a fifth of them before it; nor
/// if anything is off it while the vehicle is not known to be long (`is_long`): that may be another vehicle.
[[nodiscard]] std::optional<Turn> turn_of_flank(const Cluster& cluster, double heading_rad,
                                                const Eigen::Vector2d& sensor_m, bool is_long);

}  // namespace boresight::tracking
