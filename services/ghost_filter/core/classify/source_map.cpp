#include "services/ghost_filter/core/classify/source_map.hpp"

#include <algorithm>

namespace boresight::ghosts {

void SourceMap::clear() {
  columns_ = {};
  rows_ = {};
  movers_ = {};
}

SourceMap::Cells SourceMap::cells_of(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& half_m) {
  if (!centre_m.allFinite() || !half_m.allFinite()) return {0, kCells - 1, 0, kCells - 1};
  const Eigen::Vector2d low = centre_m - half_m, high = centre_m + half_m;
  return {cell_of(low.x()), cell_of(high.x()), cell_of(low.y()), cell_of(high.y())};
}

void SourceMap::enter_object(std::uint32_t index, const Eigen::Vector2d& centre_m, const Eigen::Vector2d& half_m) {
  const Bits bit = Bits{1} << (index % kObjectBits);
  for (std::size_t level = 0; level < kReaches_m.size(); ++level) {
    const Cells cells = cells_of(centre_m, half_m.array() + kReaches_m[level]);
    for (std::size_t k = cells.left; k <= cells.right; ++k) columns_[level][k] |= bit;
    for (std::size_t k = cells.bottom; k <= cells.top; ++k) rows_[level][k] |= bit;
  }
}

void SourceMap::enter_mover(const Eigen::Vector2d& place_m, double reach_m) {
  for (std::size_t level = 0; level < kMoverReaches; ++level) {
    const Cells cells = cells_of(place_m, Eigen::Vector2d::Constant(reach_m + kReaches_m[level]));
    const Bits columns = bits_between(cells.left, cells.right);
    for (std::size_t k = cells.bottom; k <= cells.top; ++k) movers_[level][k] |= columns;
  }
}

SourceMap::Bits SourceMap::bits_of(const Strips& strips, double coordinate_m, double reach_m) {
  const std::size_t level = level_of(reach_m);
  return level == kReaches_m.size() ? kAll : strips[level][cell_of(coordinate_m)];
}

SourceMap::Bits SourceMap::about(const Eigen::Vector2d& place_m, const Eigen::Vector2d& reach_m) const {
  if (!place_m.allFinite()) return kAll;
  const Bits objects = bits_of(columns_, place_m.x(), reach_m.x()) & bits_of(rows_, place_m.y(), reach_m.y());
  const std::size_t level = std::max(level_of(reach_m.x()), level_of(reach_m.y()));
  if (level >= kMoverReaches) return objects | kMovers;
  const Bits columns = movers_[level][cell_of(place_m.y())];
  return (objects & ~kMovers) | (columns >> cell_of(place_m.x())) << kObjectBits;
}

}  // namespace boresight::ghosts
