// Where something known is seen in a mirror.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "services/ghost_filter/core/mirror/mirror.hpp"

namespace boresight::ghosts {

/// The way from the sensor by a mirror to a place.
struct Image {
  double arc_m;               ///< of W, where the wave turns
  double first_m, second_m;   ///< |W−S|, |T−W|
  Eigen::Vector2d departure;  ///< u: from the sensor to W, unit
  Eigen::Vector2d arrival;    ///< d: from W to T, unit
};
/// Nothing if the mirror's line does not reflect from one to the other, or would so beyond its ends.
[[nodiscard]] std::optional<Image> image_of(const Mirror& mirror, const Eigen::Vector2d& sensor_m,
                                            const Eigen::Vector2d& place_m);

}  // namespace boresight::ghosts
