// Directions in order round the vehicle, in equal parts.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

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

/// A set of 64 sectors, as bits.
using SectorSet = std::uint64_t;
inline constexpr SectorSet kAllSectors = ~SectorSet{0};

/// The sectors from one direction to another, the shorter way round, and one more on either side.
[[nodiscard]] inline SectorSet sectors_between(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  constexpr std::size_t kSectors = 64;
  const bool left = from.x() * to.y() - from.y() * to.x() >= 0.0;
  const std::size_t first = sector_of<kSectors>(left ? from : to), last = sector_of<kSectors>(left ? to : from);
  const std::size_t number = (last + kSectors - first) % kSectors + 3;
  if (number >= kSectors) return kAllSectors;
  return std::rotl((SectorSet{1} << number) - 1, static_cast<int>(first) - 1);
}

/// All sectors that anything within `reach` of a place is in, and one more on either side.
[[nodiscard]] inline SectorSet sectors_about(const Eigen::Vector2d& place, double reach) {
  const double distance2 = place.squaredNorm(), reach2 = reach * reach;
  // Written so that what is not a number is everywhere, as is what is so near that it may be behind as well.
  if (!(distance2 > 2.0 * reach2)) return kAllSectors;
  const Eigen::Vector2d beside = reach / std::sqrt(distance2 - reach2) * Eigen::Vector2d(-place.y(), place.x());
  return sectors_between(place - beside, place + beside);
}

}  // namespace boresight::ghosts
