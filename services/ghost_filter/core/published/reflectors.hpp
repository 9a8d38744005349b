// Reflector segments from stationary points: clusters, and lines through them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/classified_scan.hpp"
#include "services/common/geometry/cluster_runs.hpp"
#include "services/common/geometry/dbscan.hpp"
#include "services/ghost_filter/core/published/cell_means.hpp"
#include "services/ghost_filter/core/published/config.hpp"

namespace boresight::ghosts::published {

class ReflectorFinder {
 public:
  explicit ReflectorFinder(const Config& config);

  /// Finds the segments in `points` (vehicle frame): one mean for each cell of a grid, DBSCAN of the means, then a
  /// total-least-squares line for each cluster, which is halved where its points scatter more than allowed, so that a
  /// curved rail becomes a polygon. The longest come first if there are more than kMaxReflectorSegments.
  [[nodiscard]] std::span<const ReflectorSegment> find(std::span<const Eigen::Vector2d> points);

 private:
  void fit(std::span<CellMean> points, int depth);
  void add(const ReflectorSegment& segment);
  Config config_;
  CellMeans cell_means_;
  geometry::Dbscan dbscan_;
  std::vector<Eigen::Vector2d> positions_;  // of the cells' means
  geometry::ClusterRuns<CellMean> clusters_;
  std::array<ReflectorSegment, kMaxReflectorSegments> segments_;
  std::size_t number_of_segments_ = 0;
};

}  // namespace boresight::ghosts::published
