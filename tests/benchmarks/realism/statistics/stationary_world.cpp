#include "tests/benchmarks/realism/statistics/stationary_world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace boresight::bench::realism {

namespace {

constexpr double kRing_m = 10.0;
constexpr double kNear_m = 1.0;
constexpr double kSamePlace_m = 0.5;
constexpr std::size_t kLaterScans = 13;
constexpr std::uint64_t kEvery = 4;  // neighbours are searched in every fourth scan only: their cost is quadratic

std::size_t level_of(double rcs_dbsm) {
  return rcs_dbsm < -10.0 ? 0 : rcs_dbsm < 0.0 ? 1 : rcs_dbsm < 10.0 ? 2 : 3;
}

}  // namespace

void StationaryWorld::add(const ObservedScan& scan) {
  Places places;
  for (const ObservedDetection& d : scan.detections) {
    if (!d.is_stationary()) continue;
    places.push_back(d.position_m);
    rcs_dbsm_.add(d.rcs_dbsm);
    deviation_mps_[level_of(d.rcs_dbsm)].add(d.deviation_mps);
    const auto ring = static_cast<std::size_t>(d.range_m / kRing_m);
    if (ring < kRanges) ++rings_[ring];
  }
  per_scan_[static_cast<std::size_t>(scan.facing)].add(static_cast<double>(places.size()));
  all_per_scan_.add(static_cast<double>(scan.detections.size()));

  auto& earlier = earlier_[scan.radar];
  if (scan.number % kEvery == 0) {
    for (std::size_t i = 0; i < places.size() && places.size() > 1; ++i) {
      double nearest = kEverywhere;
      unsigned near = 0;
      for (std::size_t k = 0; k < places.size(); ++k) {
        if (k == i) continue;
        const double distance = (places[k] - places[i]).norm();
        nearest = std::min(nearest, distance);
        near += distance <= kNear_m ? 1 : 0;
      }
      nearest_m_.add(nearest);
      two_near_.add(near >= 2);
    }
    if (!earlier.empty()) {
      for (const Eigen::Vector2d& place : earlier.back()) {
        again_.add(has_near(place, places, kSamePlace_m));
        for (const double turn : kChanceTurns_rad) {
          chance_.add(has_near(turned_about(place, scan.sensor_m, turn), places, kSamePlace_m));
        }
      }
    }
    if (earlier.size() == kLaterScans) {
      for (const Eigen::Vector2d& place : earlier.front()) {
        const double range_m = (place - scan.sensor_m).norm();
        if (range_m < scan.range_max_m) later_.add(has_near(place, places, kSamePlace_m));
      }
    }
  }
  if (earlier.size() == kLaterScans) earlier.pop_front();
  earlier.push_back(std::move(places));
}

void StationaryWorld::merge(const StationaryWorld& other) {
  for (std::size_t f = 0; f < per_scan_.size(); ++f) per_scan_[f].merge(other.per_scan_[f]);
  all_per_scan_.merge(other.all_per_scan_);
  for (std::size_t r = 0; r < kRanges; ++r) rings_[r] += other.rings_[r];
  rcs_dbsm_.merge(other.rcs_dbsm_);
  nearest_m_.merge(other.nearest_m_);
  for (std::size_t l = 0; l < kLevels; ++l) deviation_mps_[l].merge(other.deviation_mps_[l]);
  two_near_.merge(other.two_near_);
  again_.merge(other.again_);
  chance_.merge(other.chance_);
  later_.merge(other.later_);
}

double StationaryWorld::rate_kurtosis() const {
  double n = 0.0, sum = 0.0, squares = 0.0, fourth = 0.0;
  for (const Samples& level : deviation_mps_) {
    n += static_cast<double>(level.size());
    for (const float v : level.values()) sum += static_cast<double>(v);
  }
  const double mean = sum / n;
  for (const Samples& level : deviation_mps_) {
    for (const float v : level.values()) {
      const double square = (static_cast<double>(v) - mean) * (static_cast<double>(v) - mean);
      squares += square;
      fourth += square * square;
    }
  }
  return n * fourth / (squares * squares);
}

double StationaryWorld::rate_p95_mps() const {
  std::vector<double> sizes;
  for (const Samples& level : deviation_mps_) {
    for (const float v : level.values()) sizes.push_back(std::abs(static_cast<double>(v)));
  }
  return quantile_of(std::move(sizes), 0.95);
}

double StationaryWorld::percent_of_rings(std::size_t from, std::size_t to) const {
  double all = 0.0, within = 0.0;
  for (std::size_t r = 0; r < kRanges; ++r) {
    all += static_cast<double>(rings_[r]);
    if (r >= from && r <= to) within += static_cast<double>(rings_[r]);
  }
  return all > 0.0 ? kPercent * within / all : kNoFigure;
}

}  // namespace boresight::bench::realism
