// Moving-looking detections of the last instants of all radars, to be found by place.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_table.hpp"

namespace boresight::ghosts {

/// In the odometry frame.
struct Mover {
  Eigen::Vector2d position_m;
  Eigen::Vector2d direction;  ///< of its line of sight, unit
  double rate_mps;            ///< over ground
  double variance_m2;         ///< of its position
  double weight;              ///< of being real, not a ghost itself, and of something that is not tracked
  std::int64_t time_ns;
  std::uint32_t index;   ///< in its scan
  double rcs_dbsm;       ///< NaN: not measured
  std::uint32_t object;  ///< tracked object that it is of; counts in its own scan only
};

class RecentMovers {
 public:
  static constexpr std::size_t kCapacity = 8192;
  RecentMovers();
  void clear();
  /// Forgets what is older, and what weighs next to nothing. To be called before the scan's own are added; they are the
  /// last ones then.
  void forget(std::int64_t oldest_ns);
  void add(const Mover& mover);
  /// What the verdict on one was, for the scans to come.
  void set_weight(std::size_t i, double weight) { movers_[i].weight = weight; }
  /// Number of those of earlier scans: those from here on are of the present one.
  [[nodiscard]] std::size_t earlier() const { return earlier_; }
  [[nodiscard]] const Mover& operator[](std::size_t i) const { return movers_[i]; }
  [[nodiscard]] std::size_t size() const { return movers_.size(); }
  /// Calls `visit(mover, number)` for those in the cells about a position: within kCell_m at least.
  template <typename Visit>
  void near(const Eigen::Vector2d& position_m, const Visit& visit) const {
    const geometry::GridCell at = geometry::grid_cell(position_m.x(), position_m.y(), kCell_m);
    for (std::int32_t column = at.column - 1; column <= at.column + 1; ++column) {
      for (std::int32_t row = at.row - 1; row <= at.row + 1; ++row) {
        const std::uint32_t* const first = first_in_cell_.find({column, row});
        for (std::uint32_t i = first == nullptr ? kNone : *first; i != kNone; i = next_in_cell_[i]) {
          visit(movers_[i], i);
        }
      }
    }
  }
  static constexpr double kCell_m = 4.0;
  static constexpr double kLeastWeight = 0.02;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  void link(std::uint32_t i);
  std::vector<Mover> movers_;
  std::size_t earlier_ = 0;
  geometry::CellTable first_in_cell_, newest_;
  std::vector<std::uint32_t> next_in_cell_;
};

}  // namespace boresight::ghosts
