#include "services/ghost_filter/core/reflectors/stationary_tiles.hpp"

#include <algorithm>

namespace boresight::ghosts {

StationaryTiles::StationaryTiles() : tiles_(kTiles), points_(kTiles * kMostPoints) {}

void StationaryTiles::clear() {
  std::fill(tiles_.begin(), tiles_.end(), Tile{});
}

std::size_t StationaryTiles::number_of(geometry::GridCell place) {
  static_assert((kAcross & (kAcross - 1)) == 0);
  const auto within = [](std::int32_t i) { return static_cast<std::size_t>(i & (kAcross - 1)); };
  return within(place.row) * kAcross + within(place.column);
}

std::size_t StationaryTiles::add(const Eigen::Vector2d& position_m, std::int64_t time_ns) {
  if (!position_m.allFinite()) return kTiles;
  const geometry::GridCell place = geometry::grid_cell(position_m.x(), position_m.y(), kTile_m);
  const std::size_t number = number_of(place);
  Tile& tile = tiles_[number];
  if (!(tile.place == place)) tile = {.place = place};
  const Eigen::Vector2f from_corner = (position_m - tile.low_m()).cast<float>();
  points_[number * kMostPoints + tile.added % kMostPoints] = {from_corner.x(), from_corner.y(), time_ns};
  ++tile.added;
  tile.newest_ns = std::max(tile.newest_ns, time_ns);
  return number;
}

void StationaryTiles::collect(std::size_t number, std::int64_t oldest_ns, const Eigen::Vector2d& low_m,
                              const Eigen::Vector2d& high_m, std::vector<Eigen::Vector2d>& points) const {
  const Tile& tile = tiles_[number];
  if (tile.newest_ns < oldest_ns) return;
  const Point* const first = &points_[number * kMostPoints];
  for (const Point& p : std::span(first, std::min<std::size_t>(tile.added, kMostPoints))) {
    if (p.time_ns < oldest_ns) continue;
    const Eigen::Vector2d at = tile.low_m() + Eigen::Vector2d(p.x_m, p.y_m);
    if ((at.array() >= low_m.array()).all() && (at.array() <= high_m.array()).all()) points.push_back(at);
  }
}

void StationaryTiles::collect(std::int64_t oldest_ns, std::vector<Eigen::Vector2d>& points) const {
  const Eigen::Vector2d all = Eigen::Vector2d::Constant(kTile_m);
  for (std::size_t number = 0; number < kTiles; ++number) {
    collect(number, oldest_ns, tiles_[number].low_m() - all, tiles_[number].low_m() + 2.0 * all, points);
  }
}

std::size_t StationaryTiles::size() const {
  std::size_t sum = 0;
  for (const Tile& tile : tiles_) sum += std::min<std::size_t>(tile.added, kMostPoints);
  return sum;
}

}  // namespace boresight::ghosts
