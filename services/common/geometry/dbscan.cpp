#include "services/common/geometry/dbscan.hpp"

#include <algorithm>

namespace boresight::geometry {

namespace {
constexpr std::int32_t kUnvisited = -2;
constexpr std::uint32_t kNone = 0xFFFFFFFF;
}  // namespace

Dbscan::Dbscan(std::size_t capacity) : first_in_cell_(capacity), next_in_cell_(capacity), labels_(capacity) {
  neighbours_.reserve(capacity);
  stack_.reserve(capacity);
}

void Dbscan::fill_grid() {
  first_in_cell_.clear();
  for (std::uint32_t i = 0; i < count_; ++i) {
    std::uint32_t& first = first_in_cell_.at(grid_cell(points_[i].x(), points_[i].y(), radius_m_), kNone);
    next_in_cell_[i] = first;
    first = i;
  }
}

std::span<const std::uint32_t> Dbscan::neighbours_of(std::size_t point) {
  neighbours_.clear();
  const Eigen::Vector2d& p = points_[point];
  const GridCell cell = grid_cell(p.x(), p.y(), radius_m_);
  const double square = radius_m_ * radius_m_;
  for (std::int32_t column = cell.column - 1; column <= cell.column + 1; ++column) {
    for (std::int32_t row = cell.row - 1; row <= cell.row + 1; ++row) {
      const std::uint32_t* const first = first_in_cell_.find({column, row});
      for (std::uint32_t i = first == nullptr ? kNone : *first; i != kNone; i = next_in_cell_[i]) {
        if ((points_[i] - p).squaredNorm() <= square) neighbours_.push_back(i);
      }
    }
  }
  return neighbours_;
}

std::size_t Dbscan::cluster(std::span<const Eigen::Vector2d> points, double radius_m, std::size_t min_points) {
  points_ = points;
  radius_m_ = radius_m;
  count_ = std::min(points.size(), labels_.size());
  fill_grid();
  std::fill_n(labels_.begin(), count_, kUnvisited);
  std::int32_t clusters = 0;
  for (std::size_t seed = 0; seed < count_; ++seed) {
    if (labels_[seed] != kUnvisited) continue;
    if (neighbours_of(seed).size() < min_points) {
      labels_[seed] = kNoise;
      continue;
    }
    labels_[seed] = clusters;
    stack_.clear();
    stack_.push_back(static_cast<std::uint32_t>(seed));
    while (!stack_.empty()) {
      const std::uint32_t point = stack_.back();
      stack_.pop_back();
      const std::span<const std::uint32_t> neighbours = neighbours_of(point);
      if (neighbours.size() < min_points) continue;  // reached, but not a core: does not reach further
      for (const std::uint32_t neighbour : neighbours) {
        std::int32_t& label = labels_[neighbour];
        if (label == kUnvisited) stack_.push_back(neighbour);
        if (label == kUnvisited || label == kNoise) label = clusters;
      }
    }
    ++clusters;
  }
  return static_cast<std::size_t>(clusters);
}

}  // namespace boresight::geometry
