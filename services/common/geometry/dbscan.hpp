// Density-based clusters of points in the plane (Ester et al. 1996), with a grid so that the cost grows linearly.
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
  /// included) within `radius_m` is a core; clusters are cores within reach of each other and what they reach. Points
  /// must be finite; those beyond the capacity are ignored. Returns the number of clusters.
  std::size_t cluster(std::span<const Eigen::Vector2d> points, double radius_m, std::size_t min_points);

  /// Labels of the points of the last call, in their order.
  [[nodiscard]] std::span<const std::int32_t> labels() const { return {labels_.data(), count_}; }

 private:
  void fill_grid();
  /// Points within the radius of a point, itself included; valid until the next call.
  [[nodiscard]] std::span<const std::uint32_t> neighbours_of(std::size_t point);

  std::span<const Eigen::Vector2d> points_;
  double radius_m_ = 1.0;
  std::size_t count_ = 0;
  CellTable first_in_cell_;  // cells of the radius' size; the other points of a cell hang on the first
  std::vector<std::uint32_t> next_in_cell_;
  std::vector<std::int32_t> labels_;
  std::vector<std::uint32_t> neighbours_;
  std::vector<std::uint32_t> stack_;
};

}  // namespace boresight::geometry
