// Moving detections of one scan, grouped into what may be objects.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/classified_scan.hpp"
#include "services/common/geometry/assignment.hpp"
#include "services/common/geometry/dbscan.hpp"
#include "services/tracker/core/config.hpp"

namespace boresight::tracking {

struct Cluster {
  Eigen::Vector2d position_m;  ///< mean of the detections, each as real as it is, vehicle frame
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();  ///< of that mean by the sensor's noise
  double range_rate_over_ground_mps;
  double range_rate_variance;     ///< of the mean, m²/s²
  Eigen::Vector2d line_of_sight;  ///< unit vector from the sensor
  /// Mean of the detections' own lines of sight: of a body with velocity v the mean range rate is this times v. Nearby,
  /// a long body is seen under many angles, of which the middle one tells little.
  Eigen::Vector2d mean_sight;
  double z_min_m, z_max_m;
  double realness;  ///< probability that it is no ghost: 1 − `ghost_probability`, of those detections that count most
  double strongest_dbsm =
      std::numeric_limits<double>::quiet_NaN();  ///< RCS of the strongest detection; NaN: the sensor measures none
  std::uint32_t number_of_detections;
  double weight;                            ///< sum of that probability over the detections
  std::array<Eigen::Vector2d, 24> outline;  ///< up to 24 of the detections that are rather real, for the extent
  std::uint32_t number_on_outline;
};

/// Where a tracked object is expected in the scan.
struct KnownPlace {
  Eigen::Vector2d position_m, axis, half_m;  ///< centre; direction of the length, unit; half of length and width
  bool is_small;                             ///< a person or a cycle
  Eigen::Vector2d velocity_mps{0.0, 0.0};    ///< over ground
  /// Whether limbs or wheels of who moves so may show that range rate over ground in that direction.
  [[nodiscard]] bool may_show(double rate_mps, const Eigen::Vector2d& sight) const {
    constexpr double kMore_mps = 1.5;
    const double mean_mps = sight.dot(velocity_mps);
    return std::abs(rate_mps - mean_mps) < std::abs(mean_mps) + kMore_mps;
  }
  /// Of a point from the box.
  [[nodiscard]] double distance_m(const Eigen::Vector2d& point_m) const {
    const Eigen::Vector2d d = point_m - position_m;
    const Eigen::Vector2d at(axis.dot(d), axis.x() * d.y() - axis.y() * d.x());
    return (at.cwiseAbs() - half_m).cwiseMax(0.0).norm();
  }
};

class Clusterer {
 public:
  explicit Clusterer(const Config& config);
  /// Groups the detections of provenance kMoving, by place and then by range rate. At most Assignment::kCapacity
  /// clusters; further ones are counted. Where objects are known to be closer to each other than a cluster's radius,
  /// each detection is of the nearest of them.
  std::span<const Cluster> find(const ClassifiedScan& scan, std::span<const KnownPlace> known = {});
  /// Makes one cluster of two, which takes the place of the first; those behind the second move up.
  std::span<const Cluster> join(std::size_t first, std::size_t second);
  [[nodiscard]] std::uint32_t dropped() const { return dropped_; }

 private:
  /// Puts those first that have the median range rate, or range rates that a body shows that moves so; their number.
  std::size_t alike(const ClassifiedScan& scan, std::span<std::uint32_t> rest, const Eigen::Vector2d& velocity_mps);
  /// Clusters of the points of one place, by range rate, which a body that moves so may show different ones of.
  void split(const ClassifiedScan& scan, std::span<std::uint32_t> rest, const Eigen::Vector2d& velocity_mps);
  /// The same of `members_`, but of each of those known objects apart that are among them.
  void part(const ClassifiedScan& scan, std::span<const KnownPlace> known);
  /// The one that a point is of, or the number of all; `sight` is the unit vector to it.
  [[nodiscard]] static std::size_t owner(const Eigen::Vector2d& point_m, const Eigen::Vector2d& sight, double rate_mps,
                                         std::span<const KnownPlace> known);
  /// One cluster, of points by index.
  void add(const ClassifiedScan& scan, std::span<const std::uint32_t> members);

  Config config_;
  geometry::Dbscan dbscan_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<std::uint32_t> index_;    // detection of each point
  std::vector<std::uint32_t> members_;  // points of one place
  std::vector<std::size_t> whose_;      // known object that each point is of
  std::vector<Cluster> clusters_;
  std::uint32_t dropped_ = 0;
};

}  // namespace boresight::tracking
