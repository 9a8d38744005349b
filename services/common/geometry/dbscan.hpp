// Density-based clusters of points in the plane (Ester et al. 1996). A grid groups the points, so that the
// cost grows linearly.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_table.hpp"

namespace boresight::geometry {

/// Finds clusters without allocation after construction.
class Dbscan {
 public:
  static constexpr std::int32_t kNoise = -1;

  explicit Dbscan(std::size_t capacity);

  /// Labels each point with its cluster (0, 1, …) or kNoise. A point with at least `min_points` points (itself
  /// included) within `radius_m` is a core point. A cluster consists of core points within the radius of each other and
  /// all points within the radius of these. Points must be finite; those beyond the capacity are ignored. Returns the
  /// number of clusters.
  std::size_t cluster(std::span<const Eigen::Vector2d> points, double radius_m, std::size_t min_points);
  /// The same with a weight of each point, not negative: a core point has at least `least_weight` within the radius.
  std::size_t cluster(std::span<const Eigen::Vector2d> points, std::span<const double> weights, double radius_m,
                      double least_weight);

  /// Labels of the points of the last call, in their order.
  [[nodiscard]] std::span<const std::int32_t> labels() const { return {labels_.data(), count_}; }

 private:
  void fill_buckets();
  /// Whether a point has at least the least weight within the radius, itself included.
  [[nodiscard]] bool is_core(std::size_t point) const;
  /// Assigns points without a cluster within the radius of a core point to this cluster.
  void take_around(std::size_t core, std::int32_t cluster);

  /// A point in the order of the buckets.
  struct Entry {
    Eigen::Vector2d position;
    std::uint32_t point;
  };
  std::span<const Eigen::Vector2d> points_;
  std::span<const double> weights_;  // empty: each point weighs 1
  double radius_m_ = 1.0, least_weight_ = 1.0;
  std::size_t count_ = 0;
  std::int32_t side_ = 0;  // of the square of buckets
  /// In entries_: a bucket's begin, and the end of its points without a cluster.
  std::vector<std::uint32_t> bucket_begin_, free_end_;
  std::vector<GridCell> cells_;  // of the points, of the radius' size
  std::vector<Entry> entries_;
  std::vector<std::int32_t> labels_;
  std::vector<std::uint32_t> stack_;  // assigned, but not expanded yet
};

}  // namespace boresight::geometry
