#include "services/ghost_filter/core/reflector_map/stationary_grid.hpp"

namespace boresight::ghosts {

StationaryGrid::StationaryGrid(std::size_t capacity, double cell_m)
    : capacity_(capacity), cell_m_(cell_m), table_(capacity) {
  cells_.reserve(capacity);
}

void StationaryGrid::clear() {
  cells_.clear();
  table_.clear();
}

void StationaryGrid::add(const Eigen::Vector2d& position_m, double variance_m2, std::int64_t time_ns) {
  if (!position_m.allFinite()) return;
  const geometry::GridCell at = geometry::grid_cell(position_m.x(), position_m.y(), cell_m_);
  if (cells_.size() == capacity_ && table_.find(at) == nullptr) return;
  const auto fresh = static_cast<std::uint32_t>(cells_.size());
  const std::uint32_t index = table_.at(at, fresh);
  if (index == fresh) cells_.emplace_back();
  Cell& cell = cells_[index];
  cell.sum_m += position_m;
  cell.fresh_sum_m += position_m;
  cell.fresh_variance_m2 += variance_m2;
  ++cell.count;
  ++cell.fresh_count;
  cell.last_ns = time_ns;
}

void StationaryGrid::forget(std::int64_t oldest_ns) {
  table_.clear();
  std::size_t kept = 0;
  for (Cell& cell : cells_) {
    if (cell.last_ns < oldest_ns) continue;
    const Eigen::Vector2d p = cell.mean_m();
    // The mean of a cell's points lies in the cell; rounding at its edge may move it into one that is taken.
    static_cast<void>(table_.at(geometry::grid_cell(p.x(), p.y(), cell_m_), static_cast<std::uint32_t>(kept)));
    cell.claimed_by = kUnclaimed;
    cells_[kept++] = cell;
  }
  cells_.resize(kept);
}

void StationaryGrid::settle() {
  for (Cell& cell : cells_) {
    cell.fresh_sum_m.setZero();
    cell.fresh_variance_m2 = 0.0;
    cell.fresh_count = 0;
  }
}

std::uint32_t StationaryGrid::index_at(const Eigen::Vector2d& position_m) const {
  const std::uint32_t* const found = table_.find(geometry::grid_cell(position_m.x(), position_m.y(), cell_m_));
  return found == nullptr ? kUnclaimed : *found;
}

}  // namespace boresight::ghosts
