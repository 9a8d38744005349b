#include "services/ghost_filter/core/classify/source_map.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts {

SourceMap::SourceMap() : objects_(kReaches_m.size() * kCells * kCells, 0), movers_(kReaches_m.size() * kCells, 0) {}

void SourceMap::clear() {
  // On a road most rows are empty.
  for (std::size_t level = 0; level < kReaches_m.size(); ++level) {
    for (Bits left = rows_[level]; left != 0; left &= left - 1) {
      Bits* const row = row_of(level, std::countr_zero(left));
      std::fill(row, row + kCells, Bits{0});
    }
  }
  rows_ = {};
  std::fill(movers_.begin(), movers_.end(), Bits{0});
}

std::int32_t SourceMap::cell_of(double coordinate_m) {
  constexpr double kHalf = 0.5 * kCells;
  return static_cast<std::int32_t>(std::clamp(coordinate_m / kCell_m + kHalf, 0.0, kCells - 1.0));
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
    rows_[level] |= bits_between(cells.bottom, cells.top);
    for (std::int32_t k = cells.bottom; k <= cells.top; ++k) {
      Bits* const row = row_of(level, k);
      for (std::int32_t column = cells.left; column <= cells.right; ++column) row[column] |= bit;
    }
  }
}

void SourceMap::enter_mover(const Eigen::Vector2d& place_m, double reach_m) {
  Bits* row = movers_.data();
  for (const double reach : kReaches_m) {
    const Cells cells = cells_of(place_m, Eigen::Vector2d::Constant(reach_m + reach));
    const Bits columns = bits_between(cells.left, cells.right);
    for (std::int32_t k = cells.bottom; k <= cells.top; ++k) row[k] |= columns;
    row += kCells;
  }
}

SourceMap::Bits SourceMap::about(const Eigen::Vector2d& place_m, double reach_m) const {
  std::size_t level = 0;
  // Written so that what is not a number has no level.
  while (level < kReaches_m.size() && !(reach_m <= kReaches_m[level])) ++level;
  if (level == kReaches_m.size() || !place_m.allFinite()) return kAll;
  const std::size_t row = level * kCells + static_cast<std::size_t>(cell_of(place_m.y()));
  const auto column = static_cast<std::size_t>(cell_of(place_m.x()));
  return objects_[row * kCells + column] | (movers_[row] >> column) << kObjectBits;
}

}  // namespace boresight::ghosts
