#include "services/common/geometry/dbscan.hpp"

#include <algorithm>
#include <utility>

namespace boresight::geometry {

namespace {

constexpr std::int32_t kUnvisited = -2;

/// Buckets per side of the square: at least two buckets per point, as most cells have empty neighbours.
std::int32_t side_for(std::size_t points) {
  std::int32_t side = 4;  // three neighbouring cells are different buckets
  while (static_cast<std::size_t>(side) * static_cast<std::size_t>(side) < 2 * points) side *= 2;
  return side;
}

std::size_t buckets_for(std::size_t points) {
  const auto side = static_cast<std::size_t>(side_for(points));
  return side * side;
}

}  // namespace

Dbscan::Dbscan(std::size_t capacity)
    : bucket_begin_(buckets_for(capacity) + 1),
      free_end_(buckets_for(capacity)),
      cells_(capacity),
      entries_(capacity),
      labels_(capacity) {
  stack_.reserve(capacity);
}

void Dbscan::fill_buckets() {
  // The plane's cells repeat periodically over the square of buckets: no hashing, and neighbours stay neighbours.
  // Distant points in the same bucket are rejected by their distance.
  side_ = side_for(count_);
  const std::size_t buckets = buckets_for(count_);
  std::fill_n(bucket_begin_.begin(), buckets + 1, 0U);
  const std::int32_t mask = side_ - 1;
  const auto bucket_of = [&](const GridCell& cell) {
    return static_cast<std::size_t>((cell.column & mask) * side_ + (cell.row & mask));
  };
  for (std::size_t i = 0; i < count_; ++i) {
    cells_[i] = grid_cell(points_[i].x(), points_[i].y(), radius_m_);
    ++bucket_begin_[bucket_of(cells_[i])];
  }
  // Each bucket's end first; entering the points moves it down to the begin.
  for (std::size_t b = 1; b <= buckets; ++b) bucket_begin_[b] += bucket_begin_[b - 1];
  for (std::size_t i = 0; i < count_; ++i) {
    entries_[--bucket_begin_[bucket_of(cells_[i])]] = {points_[i], static_cast<std::uint32_t>(i)};
  }
  std::copy_n(bucket_begin_.begin() + 1, buckets, free_end_.begin());
}

bool Dbscan::is_core(std::size_t point) const {
  const Eigen::Vector2d p = points_[point];
  const double square = radius_m_ * radius_m_;
  double found = 0.0;
  const std::int32_t mask = side_ - 1;
  for (const std::int32_t beside : {0, -1, 1}) {
    for (const std::int32_t above : {0, -1, 1}) {
      const auto bucket = static_cast<std::size_t>(((cells_[point].column + beside) & mask) * side_ +
                                                   ((cells_[point].row + above) & mask));
      const std::uint32_t end = bucket_begin_[bucket + 1];
      for (std::uint32_t k = bucket_begin_[bucket]; k < end; ++k) {
        if ((entries_[k].position - p).squaredNorm() > square) continue;
        found += weights_.empty() ? 1.0 : weights_[entries_[k].point];
        if (found >= least_weight_) return true;
      }
    }
  }
  return found >= least_weight_;
}

void Dbscan::take_around(std::size_t core, std::int32_t cluster) {
  const Eigen::Vector2d p = points_[core];
  const double square = radius_m_ * radius_m_;
  const std::int32_t mask = side_ - 1;
  for (const std::int32_t beside : {-1, 0, 1}) {
    for (const std::int32_t above : {-1, 0, 1}) {
      const auto bucket = static_cast<std::size_t>(((cells_[core].column + beside) & mask) * side_ +
                                                   ((cells_[core].row + above) & mask));
      std::uint32_t& end = free_end_[bucket];
      for (std::uint32_t k = bucket_begin_[bucket]; k < end;) {
        if ((entries_[k].position - p).squaredNorm() > square) {
          ++k;
          continue;
        }
        const std::uint32_t point = entries_[k].point;
        if (labels_[point] == kUnvisited) stack_.push_back(point);  // noise is not a core point
        labels_[point] = cluster;
        // A point of a cluster is not visited again, which saves most of the work in a dense cloud.
        std::swap(entries_[k], entries_[--end]);
      }
    }
  }
}

std::size_t Dbscan::cluster(std::span<const Eigen::Vector2d> points, double radius_m, std::size_t min_points) {
  return cluster(points, {}, radius_m, static_cast<double>(min_points));
}

std::size_t Dbscan::cluster(std::span<const Eigen::Vector2d> points, std::span<const double> weights, double radius_m,
                            double least_weight) {
  points_ = points;
  weights_ = weights;
  radius_m_ = radius_m;
  least_weight_ = least_weight;
  count_ = std::min(points.size(), labels_.size());
  fill_buckets();
  std::fill_n(labels_.begin(), count_, kUnvisited);
  std::int32_t clusters = 0;
  for (std::size_t seed = 0; seed < count_; ++seed) {
    if (labels_[seed] != kUnvisited) continue;
    if (!is_core(seed)) {
      labels_[seed] = kNoise;
      continue;
    }
    stack_.clear();
    take_around(seed, clusters);
    while (!stack_.empty()) {
      const std::uint32_t point = stack_.back();
      stack_.pop_back();
      if (is_core(point)) take_around(point, clusters);  // other points belong to the cluster, but do not extend it
    }
    ++clusters;
  }
  return static_cast<std::size_t>(clusters);
}

}  // namespace boresight::geometry
