// Moving detections of one scan, grouped into what may be objects.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/classified_scan.hpp"
#include "services/common/geometry/assignment.hpp"
#include "services/common/geometry/dbscan.hpp"
#include "services/tracker/core/config.hpp"

namespace boresight::tracking {

struct Cluster {
  Eigen::Vector2d position_m;     ///< mean of the detections, vehicle frame
  Eigen::Matrix2d covariance_m2;  ///< of that mean by the sensor's noise
  double range_rate_over_ground_mps;
  double range_rate_variance;     ///< of the mean, m²/s²
  Eigen::Vector2d line_of_sight;  ///< unit vector from the sensor
  double z_min_m, z_max_m;
  std::uint32_t number_of_detections;
  std::array<Eigen::Vector2d, 16> outline;  ///< up to 16 of the detections, for the extent
};

class Clusterer {
 public:
  explicit Clusterer(const Config& config);
  /// Groups the detections of provenance kMoving. At most Assignment::kCapacity clusters; further ones are counted.
  [[nodiscard]] std::span<const Cluster> find(const ClassifiedScan& scan);
  [[nodiscard]] std::uint32_t dropped() const { return dropped_; }

 private:
  Config config_;
  geometry::Dbscan dbscan_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<std::uint32_t> index_;  // detection of each point
  std::vector<Cluster> clusters_;
  std::uint32_t dropped_ = 0;
};

}  // namespace boresight::tracking
