// Clusters of one scan's detections: DBSCAN in the plane (Ester et al. 1996) with the probability of being moving as
// the weight of a detection, then a division at gaps of the range rates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/dbscan.hpp"
#include "services/tracker/core/classical/parameters.hpp"
#include "services/tracker/core/ggiw/cell.hpp"

namespace boresight::tracking::classical {

class Clusters {
 public:
  explicit Clusters(std::size_t max_detections);

  /// Clusters of the detections that are not taken. Returns their number.
  std::size_t find(std::span<const Measurement<double>> measurements, std::span<const std::int32_t> taken_by,
                   const ClusterParameters& parameters);

  /// Indices of the detections of a cluster, in the order of range rates.
  [[nodiscard]] std::span<const std::size_t> members(std::size_t cluster) const {
    return std::span(order_).subspan(begin_[cluster], begin_[cluster + 1] - begin_[cluster]);
  }
  [[nodiscard]] const Cell<double>& cell(std::size_t cluster) const { return cells_[cluster]; }

 private:
  geometry::Dbscan dbscan_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<std::size_t> index_;  // of a point: its measurement
  std::vector<double> weights_;
  std::vector<std::int32_t> labels_;  // by measurement
  std::vector<std::size_t> order_;    // measurements by cluster
  std::vector<std::size_t> begin_;    // of each cluster in order_, and the end
  std::vector<Cell<double>> cells_;
};

}  // namespace boresight::tracking::classical
