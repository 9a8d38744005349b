#include "services/tracker/core/clusters.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

Clusterer::Clusterer(const Config& config) : config_(config), dbscan_(kMaxDetections) {
  points_.reserve(kMaxDetections);
  index_.reserve(kMaxDetections);
  clusters_.reserve(geometry::Assignment::kCapacity);
}

std::span<const Cluster> Clusterer::find(const ClassifiedScan& scan) {
  points_.clear();
  index_.clear();
  clusters_.clear();
  dropped_ = 0;
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    if (scan.provenance[i] != Provenance::kMoving) continue;
    const Eigen::Vector2d p(scan.x_vehicle_m[i], scan.y_vehicle_m[i]);
    const bool finite = std::isfinite(scan.range_rate_over_ground_mps[i]) && std::isfinite(scan.range_m[i]) &&
                        std::isfinite(scan.range_std_m[i]) && std::isfinite(scan.azimuth_std_rad[i]) &&
                        std::isfinite(scan.range_rate_std_mps[i]) && std::isfinite(scan.z_vehicle_m[i]);
    if (!p.allFinite() || !finite) continue;
    points_.push_back(p);
    index_.push_back(static_cast<std::uint32_t>(i));
  }
  const std::size_t found = dbscan_.cluster(points_, config_.cluster_radius_m, config_.cluster_min_points);
  const auto labels = dbscan_.labels();
  const Eigen::Vector2d sensor(scan.geometry.sensor_position_vehicle_m[0], scan.geometry.sensor_position_vehicle_m[1]);
  for (std::size_t c = 0; c < found; ++c) {
    if (clusters_.size() == clusters_.capacity()) {
      dropped_ += static_cast<std::uint32_t>(found - c);
      break;
    }
    // The median range rate is what the body does; ghosts and wheels in the same place do otherwise.
    std::array<float, 64> rates;
    std::size_t rates_size = 0;
    for (std::size_t k = 0; k < labels.size() && rates_size < rates.size(); ++k) {
      if (labels[k] == static_cast<std::int32_t>(c)) rates[rates_size++] = scan.range_rate_over_ground_mps[index_[k]];
    }
    const auto middle = rates.begin() + static_cast<std::ptrdiff_t>(rates_size / 2);
    std::nth_element(rates.begin(), middle, rates.begin() + static_cast<std::ptrdiff_t>(rates_size));
    const double median = *middle;

    Cluster cluster{};
    cluster.position_m.setZero();
    cluster.z_min_m = 1e9;
    cluster.z_max_m = -1e9;
    double range_variance = 0.0, cross_variance = 0.0, rate_variance = 0.0;
    std::uint32_t n = 0;
    for (std::size_t k = 0; k < labels.size(); ++k) {
      if (labels[k] != static_cast<std::int32_t>(c)) continue;
      const std::size_t i = index_[k];
      const double rate = scan.range_rate_over_ground_mps[i];
      if (std::abs(rate - median) > config_.cluster_max_range_rate_spread_mps) continue;
      cluster.position_m += points_[k];
      cluster.range_rate_over_ground_mps += rate;
      const double across = static_cast<double>(scan.range_m[i] * scan.azimuth_std_rad[i]);
      range_variance += static_cast<double>(scan.range_std_m[i] * scan.range_std_m[i]);
      cross_variance += across * across;
      rate_variance += static_cast<double>(scan.range_rate_std_mps[i] * scan.range_rate_std_mps[i]);
      cluster.z_min_m = std::min(cluster.z_min_m, static_cast<double>(scan.z_vehicle_m[i]));
      cluster.z_max_m = std::max(cluster.z_max_m, static_cast<double>(scan.z_vehicle_m[i]));
      if (n < cluster.outline.size()) cluster.outline[n] = points_[k];
      ++n;
    }
    const double count_of_cluster = n;
    cluster.number_of_detections = n;
    cluster.position_m /= count_of_cluster;
    cluster.range_rate_over_ground_mps /= count_of_cluster;
    const Eigen::Vector2d sight = cluster.position_m - sensor;
    if (sight.squaredNorm() < 1e-6) continue;
    cluster.line_of_sight = sight.normalized();
    const Eigen::Vector2d u = cluster.line_of_sight, v(-u.y(), u.x());
    const double centre_variance = config_.centre_std_m * config_.centre_std_m;
    const double square = count_of_cluster * count_of_cluster;
    cluster.covariance_m2 = (range_variance / square + centre_variance) * u * u.transpose() +
                            (cross_variance / square + centre_variance) * v * v.transpose();
    cluster.range_rate_variance = rate_variance / square + config_.range_rate_std_mps * config_.range_rate_std_mps;
    clusters_.push_back(cluster);
  }
  return clusters_;
}

}  // namespace boresight::tracking
