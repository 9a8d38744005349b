#include "services/ghost_filter/core/reflectors/cell_means.hpp"

#include <algorithm>

namespace boresight::ghosts {

CellMeans::CellMeans(std::size_t capacity) : capacity_(capacity), cells_(capacity) {
  means_.reserve(capacity);
}

std::span<const CellMean> CellMeans::find(std::span<const Eigen::Vector2d> points, double cell_m) {
  means_.clear();
  cells_.clear();
  for (const Eigen::Vector2d& p : points.first(std::min(points.size(), capacity_))) {
    if (!p.allFinite()) continue;
    const auto fresh = static_cast<std::uint32_t>(means_.size());
    const std::uint32_t index = cells_.at(geometry::grid_cell(p.x(), p.y(), cell_m), fresh);
    if (index == fresh) means_.push_back({Eigen::Vector2d::Zero(), 0});
    means_[index].position_m += p;
    ++means_[index].number_of_points;
  }
  for (CellMean& mean : means_) mean.position_m /= mean.number_of_points;
  return means_;
}

}  // namespace boresight::ghosts
