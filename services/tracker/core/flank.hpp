// The line that is seen along the flank of a long vehicle.
#pragma once

#include <optional>

#include "services/tracker/core/clusters.hpp"
#include "services/tracker/core/heading.hpp"

namespace boresight::tracking {

/// What is seen along the flank of a long vehicle lies along its heading. Of the outline, that is the line on which the
/// most of it lies, within 0.5 rad of `heading_rad`, the heading that is known: what else is seen is of an end, of the
/// axles' far sides or a ghost. Nothing if it is shorter than 5 m, or of fewer than three detections or a third of
/// them.
[[nodiscard]] std::optional<Turn> turn_of_flank(const Cluster& cluster, double heading_rad);

}  // namespace boresight::tracking
