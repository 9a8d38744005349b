#include "services/common/geometry/dbscan.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::geometry {

namespace {

constexpr std::int32_t kUnvisited = -2;

std::int64_t cell_of(double coordinate, double size) {
  return static_cast<std::int64_t>(std::floor(std::clamp(coordinate, -1e6, 1e6) / size));
}
std::int64_t key_of(std::int64_t column, std::int64_t row) {
  return column * (std::int64_t{1} << 31) + row;
}

}  // namespace

Dbscan::Dbscan(std::size_t capacity) {
  cells_.reserve(capacity);
  labels_.resize(capacity);
  stack_.reserve(capacity);
}

template <typename Visit>
void Dbscan::for_neighbours(std::size_t point, Visit&& visit) const {
  const Eigen::Vector2d& p = points_[point];
  const std::int64_t column = cell_of(p.x(), radius_m_), row = cell_of(p.y(), radius_m_);
  const double square = radius_m_ * radius_m_;
  for (std::int64_t c = column - 1; c <= column + 1; ++c) {
    // The three rows of a column are neighbours in the sorted list.
    const std::int64_t last_key = key_of(c, row + 1);
    auto cell = std::lower_bound(cells_.begin(), cells_.end(), key_of(c, row - 1),
                                 [](const Cell& a, std::int64_t key) { return a.key < key; });
    for (; cell != cells_.end() && cell->key <= last_key; ++cell) {
      if ((points_[cell->point] - p).squaredNorm() <= square) visit(cell->point);
    }
  }
}

std::size_t Dbscan::cluster(std::span<const Eigen::Vector2d> points, double radius_m, std::size_t min_points) {
  points_ = points;
  radius_m_ = radius_m;
  count_ = std::min(points.size(), labels_.size());
  cells_.clear();
  for (std::size_t i = 0; i < count_; ++i) {
    cells_.push_back(
        {key_of(cell_of(points[i].x(), radius_m), cell_of(points[i].y(), radius_m)), static_cast<std::uint32_t>(i)});
  }
  std::sort(cells_.begin(), cells_.end(),
            [](const Cell& a, const Cell& b) { return a.key != b.key ? a.key < b.key : a.point < b.point; });
  std::fill_n(labels_.begin(), count_, kUnvisited);
  std::int32_t clusters = 0;
  for (std::size_t seed = 0; seed < count_; ++seed) {
    if (labels_[seed] != kUnvisited) continue;
    std::size_t reached = 0;
    for_neighbours(seed, [&](std::uint32_t) { ++reached; });
    if (reached < min_points) {
      labels_[seed] = kNoise;
      continue;
    }
    labels_[seed] = clusters;
    stack_.clear();
    stack_.push_back(static_cast<std::uint32_t>(seed));
    while (!stack_.empty()) {
      const std::uint32_t point = stack_.back();
      stack_.pop_back();
      std::size_t neighbours = 0;
      for_neighbours(point, [&](std::uint32_t) { ++neighbours; });
      if (neighbours < min_points) continue;  // reached, but not a core: does not reach further
      for_neighbours(point, [&](std::uint32_t neighbour) {
        std::int32_t& label = labels_[neighbour];
        if (label == kUnvisited) stack_.push_back(neighbour);
        if (label == kUnvisited || label == kNoise) label = clusters;
      });
    }
    ++clusters;
  }
  return static_cast<std::size_t>(clusters);
}

}  // namespace boresight::geometry
