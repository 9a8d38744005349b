#include "services/tracker/core/classical/clusters.hpp"

#include <algorithm>
#include <numeric>

namespace boresight::tracking::classical {

Clusters::Clusters(std::size_t max_detections) : dbscan_(max_detections) {
  points_.reserve(max_detections);
  index_.reserve(max_detections);
  weights_.reserve(max_detections);
  labels_.reserve(max_detections);
  order_.reserve(max_detections);
  begin_.reserve(max_detections + 1);
  cells_.reserve(max_detections);
}

std::size_t Clusters::find(std::span<const Measurement<double>> measurements, std::span<const std::int32_t> taken_by,
                           const ClusterParameters& parameters) {
  points_.clear();
  index_.clear();
  weights_.clear();
  order_.clear();
  begin_.clear();
  cells_.clear();
  for (std::size_t i = 0; i < measurements.size() && index_.size() < index_.capacity(); ++i) {
    if (taken_by[i] >= 0) continue;
    points_.emplace_back(measurements[i].position_m.x, measurements[i].position_m.y);
    index_.push_back(i);
    weights_.push_back(measurements[i].moving);
  }
  labels_.assign(measurements.size(), geometry::Dbscan::kNoise);
  dbscan_.cluster(points_, weights_, parameters.radius_m, parameters.least_weight);
  for (std::size_t k = 0; k < index_.size(); ++k) {
    labels_[index_[k]] = dbscan_.labels()[k];
    if (dbscan_.labels()[k] != geometry::Dbscan::kNoise) order_.push_back(index_[k]);
  }
  std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    if (labels_[a] != labels_[b]) return labels_[a] < labels_[b];
    if (measurements[a].range_rate_mps != measurements[b].range_rate_mps) {
      return measurements[a].range_rate_mps < measurements[b].range_rate_mps;
    }
    return a < b;
  });
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const std::size_t i = order_[k], before = k > 0 ? order_[k - 1] : i;
    if (k == 0 || labels_[i] != labels_[before] ||
        measurements[i].range_rate_mps - measurements[before].range_rate_mps > parameters.range_rate_gap_mps) {
      begin_.push_back(k);
      cells_.emplace_back();
    }
    cells_.back().add(measurements[i], 1.0);
  }
  begin_.push_back(order_.size());
  return cells_.size();
}

}  // namespace boresight::tracking::classical
