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
#include "services/tracker/core/owners.hpp"
#include "services/tracker/core/rules_config.hpp"

namespace boresight::tracking {

struct Cluster {
  Eigen::Vector2d position_m;  ///< mean of the detections, each as real as it is, vehicle frame
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();  ///< of that mean by the sensor's noise
  double range_rate_over_ground_mps;  ///< mean of the body's: of most detections, where most are alike, without wheels
  double range_rate_variance;         ///< of that mean by the sensor's noise, m²/s²
  Eigen::Vector2d line_of_sight;      ///< unit vector from the sensor
  /// Mean of those detections' own lines of sight: of a body with velocity v the mean range rate is this times v.
  /// Nearby, a long body is seen under many angles, of which the middle one tells little.
  Eigen::Vector2d mean_sight;
  double z_min_m, z_max_m;
  double realness;  ///< probability that it is no ghost: 1 − `ghost_probability`, of those detections that count most
  double strongest_dbsm =
      std::numeric_limits<double>::quiet_NaN();  ///< RCS of the strongest detection; NaN: the sensor measures none
  std::uint32_t number_of_detections;
  double weight;                            ///< sum of that probability over the detections
  std::array<Eigen::Vector2d, 24> outline;  ///< up to 24 of the detections that are rather real, for the extent
  std::array<double, 24> outline_rate_mps;  ///< range rates over ground of the same
  std::array<double, 24> outline_dbsm;      ///< RCS of the same; NaN: the sensor measures none
  std::uint32_t number_on_outline;
};

class Clusterer {
 public:
  explicit Clusterer(const RulesConfig& config);
  /// Groups the detections of provenance kMoving, by place and then by range rate. At most Assignment::kCapacity
  /// clusters; further ones are counted. Where objects are known to be closer to each other than a cluster's radius,
  /// each detection is of the one that it is likeliest of (owners.hpp).
  std::span<const Cluster> find(const ClassifiedScan& scan, std::span<const KnownPlace> known = {});
  /// Makes one cluster of two, which takes the place of the first; those behind the second move up.
  std::span<const Cluster> join(std::size_t first, std::size_t second);
  [[nodiscard]] std::uint32_t dropped() const { return dropped_; }

 private:
  /// Puts those first whose range rate is the median, or what a body shows that moves so, but for `spread_mps`; their
  /// number.
  std::size_t alike(const ClassifiedScan& scan, std::span<std::uint32_t> rest, const Eigen::Vector2d& velocity_mps,
                    double spread_mps);
  /// Clusters of the points of one place, by range rate, which a body that moves so may show different ones of.
  void split(const ClassifiedScan& scan, std::span<std::uint32_t> rest, const Eigen::Vector2d& velocity_mps);
  /// The same of `members_`, but of each of those known objects apart that are among them.
  void part(const ClassifiedScan& scan, std::span<const KnownPlace> known);
  /// What the scan says of a point.
  [[nodiscard]] Seen seen(const ClassifiedScan& scan, std::uint32_t point) const;
  /// One cluster, of points by index, those first that show the body's range rate; with the velocity, if it is known.
  void add(const ClassifiedScan& scan, std::span<std::uint32_t> members, const Eigen::Vector2d& velocity_mps);

  RulesConfig config_;
  geometry::Dbscan dbscan_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<std::uint32_t> index_;    // detection of each point
  std::vector<std::uint32_t> members_;  // points of one place
  std::vector<std::size_t> whose_;      // known object that each point is of
  std::vector<Cluster> clusters_;
  std::uint32_t dropped_ = 0;
};

}  // namespace boresight::tracking
