// Reflectors (rails, walls) tracked over time. What there is to do is spread over the scans: each takes in its own
// detections, and a share of the reflectors and of the plane's tiles comes round with it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/classified_scan.hpp"
#include "services/common/geometry/cluster_runs.hpp"
#include "services/common/geometry/dbscan.hpp"
#include "services/ghost_filter/core/reflector_map/config.hpp"
#include "services/ghost_filter/core/reflector_map/curve_search.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"
#include "services/ghost_filter/core/reflector_map/reflector.hpp"
#include "services/ghost_filter/core/reflector_map/reflector_index.hpp"
#include "services/ghost_filter/core/reflector_map/stationary_grid.hpp"

namespace boresight::ghosts {

/// Stds of the ego motion by which the odometry went on.
struct DriftStds {
  double speed_mps, yaw_rate_radps;
};

class ReflectorMap {
 public:
  explicit ReflectorMap(const MapConfig& config);

  void clear();
  /// A stationary detection in the odometry frame, with the variance of its place. It tells of the reflector that it
  /// lies on, if one is known. Not finite: ignored. `cell` is the grid's there, if it was asked for; what it is now is
  /// returned.
  std::uint32_t add(const Eigen::Vector2d& position_m, double variance_m2, std::int64_t time_ns,
                    std::uint32_t cell = StationaryGrid::kUnclaimed);
  /// After the detections of a scan: fits the reflectors that are due to what is new about them, forgets what is old in
  /// the tiles that are due and looks for new reflectors there.
  void update(const Odometry& odometry, double speed_std_mps, double yaw_rate_std_radps);

  [[nodiscard]] std::span<const Reflector> reflectors() const { return reflectors_; }
  [[nodiscard]] const StationaryGrid& grid() const { return grid_; }
  /// Reflectors that were found so far.
  [[nodiscard]] std::uint32_t births() const { return births_; }
  /// Points that were looked at to find them: the measure of what that costs.
  [[nodiscard]] std::uint64_t points_searched() const { return points_searched_; }

 private:
  /// The one that a detection lies on, and where along it.
  [[nodiscard]] Reflector* reflector_of(const Eigen::Vector2d& position_m, double variance_m2, double& arc_m);
  void refine_due(const Odometry& odometry, double elapsed_s, const DriftStds& stds);
  void refine(Reflector& r, const Odometry& odometry, const DriftStds& stds);
  /// Whether it and another one were one; what is not needed any more is dead then.
  bool unite(Reflector& r);
  void visit_tiles(std::int64_t now_ns, double elapsed_s);
  void search(const StationaryGrid::Tile& tile);
  void search_part(std::span<Eigen::Vector2d> points, int depth);
  void take(const FoundCurve& found, std::span<const Eigen::Vector2d> points);
  MapConfig config_;
  StationaryGrid grid_;
  CurveSearch curves_;
  geometry::Dbscan dbscan_;
  geometry::ClusterRuns<Eigen::Vector2d> clusters_, exact_clusters_;
  ReflectorIndex index_;
  std::vector<Reflector> reflectors_;
  std::vector<Eigen::Vector2d> free_, inexact_;  // cells that no reflector claims; the latter end up in the former
  std::size_t next_reflector_ = 0, next_tile_ = 0;
  std::int64_t updated_ns_ = 0, indexed_ns_ = 0, now_ns_ = 0;
  bool index_is_due_ = true;
  std::uint32_t births_ = 0;
  std::uint64_t points_searched_ = 0;
};

}  // namespace boresight::ghosts
