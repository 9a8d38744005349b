// Line segments among stationary points: clusters, and lines through them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/classified_scan.hpp"
#include "services/common/geometry/cluster_runs.hpp"
#include "services/common/geometry/dbscan.hpp"
#include "services/ghost_filter/core/published/config.hpp"
#include "services/ghost_filter/core/reflectors/cell_means.hpp"
#include "services/ghost_filter/core/reflectors/segment.hpp"

namespace boresight::ghosts::published {

class SegmentFinder {
 public:
  /// For at most `capacity` points; those beyond are ignored.
  SegmentFinder(const Config& config, std::size_t capacity);

  /// Finds the segments in `points`, in their frame: one mean for each cell of a grid, DBSCAN of the means, then a
  /// total-least-squares line for each cluster. A cluster whose points scatter more than allowed is halved, so that a
  /// curved rail becomes a polygon. If there are more than kMaxReflectorSegments, the longest are kept.
  [[nodiscard]] std::span<const Segment> find(std::span<const Eigen::Vector2d> points);

 private:
  void fit(std::span<CellMean> points, int depth);
  void add(const Segment& segment);
  Config config_;
  CellMeans cell_means_;
  geometry::Dbscan dbscan_;
  std::vector<Eigen::Vector2d> positions_;  // of the cells' means
  geometry::ClusterRuns<CellMean> clusters_;
  std::array<Segment, kMaxReflectorSegments> segments_;
  std::size_t number_of_segments_ = 0;
};

}  // namespace boresight::ghosts::published
