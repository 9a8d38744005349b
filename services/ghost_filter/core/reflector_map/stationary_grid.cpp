#include "services/ghost_filter/core/reflector_map/stationary_grid.hpp"

namespace boresight::ghosts {

namespace {

geometry::GridCell tile_of(geometry::GridCell cell) {
  const auto divided = [](std::int32_t i) {
    return (i >= 0 ? i : i - (StationaryGrid::kTileCells - 1)) / StationaryGrid::kTileCells;
  };
  return {divided(cell.column), divided(cell.row)};
}

}  // namespace

StationaryGrid::StationaryGrid(std::size_t capacity, double cell_m)
    : cell_m_(cell_m), table_(capacity), tile_table_(capacity), cells_(capacity), links_(capacity) {
  unused_.reserve(capacity);
  tiles_.reserve(capacity);
  clear();
}

void StationaryGrid::clear() {
  table_.clear();
  tile_table_.clear();
  tiles_.clear();
  unused_.clear();
  for (std::size_t i = cells_.size(); i-- > 0;) unused_.push_back(static_cast<std::uint32_t>(i));
}

std::uint32_t StationaryGrid::add(const Eigen::Vector2d& position_m, std::int64_t time_ns, bool claimed, bool exact,
                                  std::uint32_t index) {
  if (!position_m.allFinite()) return kUnclaimed;
  const geometry::GridCell at = geometry::grid_cell(position_m.x(), position_m.y(), cell_m_);
  if (index == kUnclaimed) index = index_at(position_m);  // another of the scan may have begun it
  if (index == kUnclaimed) {
    if (unused_.empty()) return kUnclaimed;
    index = unused_.back();
    unused_.pop_back();
    table_.at(at, index) = index;
    const geometry::GridCell place = tile_of(at);
    const auto last = static_cast<std::uint32_t>(tiles_.size());
    const std::uint32_t number = tile_table_.at(place, last);
    if (number == last) tiles_.push_back({.place = place});
    Tile& tile = tiles_[number];
    cells_[index] = {.first_ns = time_ns};
    links_[index] = {.place = at, .next = tile.first};
    tile.first = index;
    ++tile.cells;
    ++tile.news;
  }
  Cell& cell = cells_[index];
  Link& link = links_[index];
  if (exact && !link.exact) {
    // What was measured worse before does not count for the mean.
    cell.sum_m = cell.count * position_m;
    link.exact = true;
    if (cell.count > 0) ++tiles_[*tile_table_.find(tile_of(at))].news;
  }
  cell.sum_m += exact || !link.exact ? position_m : cell.mean_m();
  ++cell.count;
  link.last_ns = time_ns;
  link.claimed = claimed;
  return index;
}

bool StationaryGrid::forget(std::size_t number, std::int64_t oldest_ns) {
  Tile& tile = tiles_[number];
  for (std::uint32_t* index = &tile.first; *index != kUnclaimed;) {
    Link& link = links_[*index];
    if (link.last_ns >= oldest_ns) {
      index = &link.next;
      continue;
    }
    table_.erase(link.place);
    cells_[*index].count = 0;
    unused_.push_back(*index);
    *index = link.next;
    --tile.cells;
  }
  if (tile.first != kUnclaimed) return true;
  tile_table_.erase(tile.place);
  tile = tiles_.back();
  tiles_.pop_back();
  if (number < tiles_.size()) tile_table_.at(tile.place, 0) = static_cast<std::uint32_t>(number);
  return false;
}

std::uint32_t StationaryGrid::index_at(const Eigen::Vector2d& position_m) const {
  const std::uint32_t* const found = table_.find(geometry::grid_cell(position_m.x(), position_m.y(), cell_m_));
  return found == nullptr ? kUnclaimed : *found;
}

void StationaryGrid::claim(const Eigen::Vector2d& position_m) {
  const std::uint32_t index = index_at(position_m);
  if (index != kUnclaimed) links_[index].claimed = true;
}

}  // namespace boresight::ghosts
