#include "services/ghost_filter/core/classify/source_map.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts {

namespace {
constexpr std::size_t index_of(std::size_t level, std::int32_t column, std::int32_t row, std::int32_t cells) {
  return (level * static_cast<std::size_t>(cells) + static_cast<std::size_t>(row)) * static_cast<std::size_t>(cells) +
         static_cast<std::size_t>(column);
}
}  // namespace

SourceMap::SourceMap() : bits_(kReaches_m.size() * kCells * kCells, 0) {}

void SourceMap::clear() {
  std::fill(bits_.begin(), bits_.end(), Bits{0});
}

std::int32_t SourceMap::cell_of(double coordinate_m) {
  constexpr double kHalf = 0.5 * kCells;
  return static_cast<std::int32_t>(std::clamp(coordinate_m / kCell_m + kHalf, 0.0, kCells - 1.0));
}

void SourceMap::enter(Bits bit, const Eigen::Vector2d& centre_m, const Eigen::Vector2d& half_m) {
  if (!centre_m.allFinite() || !half_m.allFinite()) {
    for (Bits& bits : bits_) bits |= bit;
    return;
  }
  for (std::size_t level = 0; level < kReaches_m.size(); ++level) {
    const Eigen::Vector2d half = half_m.array() + kReaches_m[level];
    const std::int32_t left = cell_of(centre_m.x() - half.x()), right = cell_of(centre_m.x() + half.x());
    const std::int32_t top = cell_of(centre_m.y() + half.y());
    for (std::int32_t row = cell_of(centre_m.y() - half.y()); row <= top; ++row) {
      for (std::int32_t column = left; column <= right; ++column) bits_[index_of(level, column, row, kCells)] |= bit;
    }
  }
}

void SourceMap::enter_object(std::uint32_t index, const Eigen::Vector2d& centre_m, const Eigen::Vector2d& half_m) {
  enter(Bits{1} << (index % kObjectBits), centre_m, half_m);
}

void SourceMap::enter_mover(const Eigen::Vector2d& place_m, double reach_m) {
  enter(kMovers, place_m, {reach_m, reach_m});
}

SourceMap::Bits SourceMap::about(const Eigen::Vector2d& place_m, double reach_m) const {
  std::size_t level = 0;
  // Written so that what is not a number has no level.
  while (level < kReaches_m.size() && !(reach_m <= kReaches_m[level])) ++level;
  if (level == kReaches_m.size() || !place_m.allFinite()) return kAll;
  return bits_[index_of(level, cell_of(place_m.x()), cell_of(place_m.y()), kCells)];
}

}  // namespace boresight::ghosts
