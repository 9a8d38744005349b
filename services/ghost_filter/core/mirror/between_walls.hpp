// Ways to and fro between two walls: what drives between them is lit by one wall, which the other lights.
#pragma once

#include "services/ghost_filter/core/mirror/meeting.hpp"

namespace boresight::ghosts {

/// As meet(), of a ray from the sensor itself, for the way by one mirror and then by another. Nothing where one of them
/// is not as good as straight as far as the wave turns. `point_m` and `arrival` are of the second one.
[[nodiscard]] std::optional<Meeting> meet_between(const Mirror& first, const Mirror& second,
                                                  const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& direction,
                                                  double length_m);

}  // namespace boresight::ghosts
