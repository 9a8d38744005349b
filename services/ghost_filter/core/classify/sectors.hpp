// Directions in order round the vehicle, in equal parts.
#pragma once

#include <cmath>
#include <cstddef>

#include <Eigen/Core>

namespace boresight::ghosts {

/// Round the square |x| + |y| = 1 instead of the circle: as good an order of directions, without an arc tangent.
template <std::size_t kSectors>
[[nodiscard]] std::size_t sector_of(const Eigen::Vector2d& direction) {
  const double size = std::abs(direction.x()) + std::abs(direction.y());
  const double y = size > 0.0 ? direction.y() / size : 0.0;
  const double round = direction.x() >= 0.0 ? 1.0 + y : 3.0 - y;  // 0 … 4 from −y by +x
  return static_cast<std::size_t>(round * (kSectors / 4.0)) % kSectors;
}

}  // namespace boresight::ghosts
