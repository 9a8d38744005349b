// Moving-looking detections of the last second of all radars, to be found by place.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_chains.hpp"
#include "services/common/geometry/cell_table.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"

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

/// The same at the instant of the scan, vehicle frame and axes.
struct MovedMover {
  Eigen::Vector2d position_m, direction;
  double variance_m2;  ///< of its position, with what it may have gone otherwise
};

/// Standard deviations beyond which a mover is taken not to be at a place.
inline constexpr double kFarMover = 4.0;

class RecentMovers {
 public:
  static constexpr std::size_t kCapacity = 8192;
  RecentMovers();
  void clear();
  /// Forgets what is older, and what is older than `oldest_source_ns` weighs nothing any more. To be called before the
  /// scan's own are added; they are the last ones then. Where they are is told as of `odometry`.
  void forget(std::int64_t oldest_ns, std::int64_t oldest_source_ns, const Odometry& odometry);
  void add(const Mover& mover, const Odometry& odometry);
  /// What the verdict on one was, for the scans to come.
  void set_weight(std::size_t i, double weight) { movers_[i].weight = weight; }
  /// Number of those of earlier scans: those from here on are of the present one.
  [[nodiscard]] std::size_t earlier() const { return earlier_; }
  [[nodiscard]] const Mover& operator[](std::size_t i) const { return movers_[i]; }
  [[nodiscard]] std::size_t size() const { return movers_.size(); }
  /// Calls `visit(mover, number)` for those that have moved on into the cells about a position in the odometry frame,
  /// within kCell_m at least, and for some that are far away.
  template <typename Visit>
  void near(const Eigen::Vector2d& position_m, const Visit& visit) const {
    all_.near(position_m, [&](std::uint32_t i) { visit(movers_[i], i); });
  }
  /// Calls `visit(mover, moved, number)` for those that weigh something, in the cells about where they were detected.
  template <typename Visit>
  void weighing_near(const Eigen::Vector2d& position_m, const Visit& visit) const {
    weighing_.near(position_m, [&](std::uint32_t i) { visit(movers_[i], moved_[i], i); });
  }
  /// Calls `visit(moved)` for all that weigh something.
  template <typename Visit>
  void visit_weighing(const Visit& visit) const {
    for (std::size_t i = 0; i < movers_.size(); ++i) {
      if (weighs(movers_[i])) visit(moved_[i]);
    }
  }
  static constexpr double kCell_m = 4.0;
  static constexpr double kLeastWeight =
      0.02;  ///< of what most likely is a ghost itself, nothing else is seen to be one

 private:
  [[nodiscard]] bool weighs(const Mover& mover) const {
    return mover.weight > kLeastWeight && mover.time_ns >= oldest_source_ns_;
  }
  void enter(std::uint32_t i, const Odometry& odometry);
  std::vector<Mover> movers_;
  std::vector<MovedMover> moved_;  // of those that weigh something
  std::size_t earlier_ = 0;
  std::int64_t oldest_source_ns_ = 0;
  geometry::CellChains all_{kCapacity, kCell_m}, weighing_{kCapacity, kCell_m};
  geometry::CellTable newest_;
};

}  // namespace boresight::ghosts
