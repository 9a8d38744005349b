#include "services/ghost_filter/core/classify/moving_bodies.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "services/common/geometry/cell_table.hpp"

namespace boresight::ghosts {

namespace {
constexpr double kRather = 0.5;  // weight from which on an object is rather there than an image
constexpr double kMoves = 0.8;   // probability from which on what an object shows is no part of the map
}  // namespace

MovingBodies::MovingBodies(std::size_t capacity)
    : words_((capacity + 63) / 64), columns_(words_ * kStrips), rows_(words_ * kStrips) {
  numbers_.reserve(capacity);
}

void MovingBodies::find(std::span<const Object> objects) {
  objects_ = objects;
  numbers_.clear();
  std::fill(columns_.begin(), columns_.end(), 0U);
  std::fill(rows_.begin(), rows_.end(), 0U);
  for (std::uint32_t i = 0; i < objects.size() && numbers_.size() < numbers_.capacity(); ++i) {
    const Object& o = objects[i];
    if (o.weight <= kRather || o.moving < kMoves) continue;
    const double length = o.half_length_m + kAround_m, width = o.half_width_m + kAround_m;
    const double reach_m = std::sqrt(length * length + width * width);
    const auto low = geometry::grid_cell(o.position_m.x() - reach_m, o.position_m.y() - reach_m, kStrip_m);
    const auto high = geometry::grid_cell(o.position_m.x() + reach_m, o.position_m.y() + reach_m, kStrip_m);
    enter(columns_, low.column, high.column, numbers_.size());
    enter(rows_, low.row, high.row, numbers_.size());
    numbers_.push_back(i);
  }
}

void MovingBodies::enter(std::vector<std::uint64_t>& strips, std::int32_t first, std::int32_t last,
                         std::size_t body) const {
  last = std::min(last, first + kStrips - 1);  // those are all
  for (std::int32_t strip = first; strip <= last; ++strip) {
    bits(strips, strip, body / 64) |= std::uint64_t{1} << (body % 64);
  }
}

bool MovingBodies::any_at(const Eigen::Vector2d& place_m) const {
  const geometry::GridCell at = geometry::grid_cell(place_m.x(), place_m.y(), kStrip_m);
  const std::uint64_t* const column = &columns_[static_cast<std::size_t>(at.column & (kStrips - 1)) * words_];
  const std::uint64_t* const row = &rows_[static_cast<std::size_t>(at.row & (kStrips - 1)) * words_];
  for (std::size_t word = 0; word < words_; ++word) {
    for (std::uint64_t left = column[word] & row[word]; left != 0; left &= left - 1) {
      const std::size_t body = 64 * word + static_cast<std::size_t>(std::countr_zero(left));
      if (is_on(objects_[numbers_[body]], place_m, kAround_m)) return true;
    }
  }
  return false;
}

}  // namespace boresight::ghosts
