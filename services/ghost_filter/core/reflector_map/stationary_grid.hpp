// The stationary detections of the recent past of all radars, one mean for each cell of a grid that stands still.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_table.hpp"

namespace boresight::ghosts {

class StationaryGrid {
 public:
  static constexpr std::uint32_t kUnclaimed = std::numeric_limits<std::uint32_t>::max();
  struct Cell {
    Eigen::Vector2d sum_m{0.0, 0.0};
    Eigen::Vector2d fresh_sum_m{0.0, 0.0};  ///< of the detections since the reflectors were last updated
    double fresh_variance_m2 = 0.0;         ///< sum of their position variances
    std::uint32_t count = 0;
    std::uint32_t fresh_count = 0;
    std::int64_t last_ns = 0;
    std::uint32_t claimed_by = kUnclaimed;  ///< reflector of this update
    [[nodiscard]] Eigen::Vector2d mean_m() const { return sum_m / count; }
    [[nodiscard]] Eigen::Vector2d fresh_mean_m() const { return fresh_sum_m / fresh_count; }
  };

  /// Room for `capacity` cells; points in further ones are dropped until the oldest are forgotten.
  StationaryGrid(std::size_t capacity, double cell_m);

  void clear();
  /// A detection that looks stationary; not finite: ignored.
  void add(const Eigen::Vector2d& position_m, double variance_m2, std::int64_t time_ns);
  /// Forgets the cells last hit before `oldest_ns`, and who claimed the others.
  void forget(std::int64_t oldest_ns);
  /// What is fresh now is not at the next update.
  void settle();

  [[nodiscard]] double cell_m() const { return cell_m_; }
  [[nodiscard]] std::span<const Cell> cells() const { return cells_; }
  [[nodiscard]] std::span<Cell> cells() { return cells_; }
  /// Index of the cell at a position, or kUnclaimed.
  [[nodiscard]] std::uint32_t index_at(const Eigen::Vector2d& position_m) const;

 private:
  std::size_t capacity_;
  double cell_m_;
  geometry::CellTable table_;
  std::vector<Cell> cells_;
};

}  // namespace boresight::ghosts
