// Many points thinned to one for each cell of a grid, so that what follows costs by area and not by density.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_table.hpp"

namespace boresight::ghosts {

/// The mean of the points in one cell.
struct CellMean {
  Eigen::Vector2d position_m;
  std::uint32_t number_of_points;
};

class CellMeans {
 public:
  /// Allocates for at most `capacity` points.
  explicit CellMeans(std::size_t capacity);
  /// In the order in which the cells were first met. Points beyond the capacity, and points that are not finite, are
  /// ignored.
  [[nodiscard]] std::span<const CellMean> find(std::span<const Eigen::Vector2d> points, double cell_m);

 private:
  std::size_t capacity_;
  geometry::CellTable cells_;  // index of the cell's mean
  std::vector<CellMean> means_;
};

}  // namespace boresight::ghosts
