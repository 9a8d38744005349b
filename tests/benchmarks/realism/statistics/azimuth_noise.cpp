#include "tests/benchmarks/realism/statistics/azimuth_noise.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::bench::realism {

namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr std::array<std::array<double, 2>, AzimuthNoise::kBands> kBands_deg{{{0.0, 20.0}, {20.0, 50.0}, {60.0, 70.0}}};
constexpr std::array<double, AzimuthNoise::kCarRanges + 1> kCarEdges_m{20.0, 50.0, 100.0};
constexpr double kSpeedBin_mps = 3.0;
constexpr std::size_t kLeastOfSpeed = 200;  // detections: 7 % of the standard deviation
constexpr std::size_t kLeastOfCar = 5;      // detections for a median

/// kCarRanges if in none.
std::size_t car_range(double range_m) {
  if (range_m < kCarEdges_m.front()) return AzimuthNoise::kCarRanges;
  const auto above = std::upper_bound(kCarEdges_m.begin(), kCarEdges_m.end(), range_m);
  return static_cast<std::size_t>(above - kCarEdges_m.begin()) - 1;
}

Eigen::Vector2d left_of(const Eigen::Vector2d& sight) {
  return {-sight.y(), sight.x()};
}

}  // namespace

void AzimuthNoise::add(const ObservedScan& scan) {
  for (const ObservedDetection& d : scan.detections) {
    if (!d.is_stationary()) continue;
    const double off_deg = std::abs(d.azimuth_rad) / kDegree;
    for (std::size_t b = 0; b < kBands; ++b) {
      if (off_deg < kBands_deg[b][0] || off_deg > kBands_deg[b][1]) continue;
      const double speed_mps = std::abs(left_of(scan.sight_to(d.position_m)).dot(scan.sensor_velocity_mps));
      Bin& bin = bins_[b][std::min(static_cast<std::size_t>(speed_mps / kSpeedBin_mps), kSpeeds - 1)];
      bin.deviation_mps.add(d.deviation_mps);
      bin.squared_speeds += speed_mps * speed_mps;
    }
  }
  for (const ObservedObject& object : scan.objects) {
    if (object.user != RoadUser::kCar) continue;
    const Eigen::Vector2d left = left_of(scan.sight_to(object.position_m));
    for (const ObservedDetection& d : scan.detections) {
      if (!d.is_direct_of(object.id)) continue;
      const std::size_t range = car_range(d.range_m);
      if (range < kCarRanges) {
        open_[{scan.radar, object.id, range}].push_back(left.dot(d.position_m - object.position_m));
      }
    }
  }
}

void AzimuthNoise::end_drive() {
  for (const auto& [key, across_m] : open_) {
    if (across_m.size() < kLeastOfCar) continue;
    const double middle = quantile_of(across_m, 0.5);
    for (const double v : across_m) car_across_m_[std::get<2>(key)].add(v - middle);
  }
  open_.clear();
}

void AzimuthNoise::merge(const AzimuthNoise& other) {
  for (std::size_t b = 0; b < kBands; ++b) {
    for (std::size_t s = 0; s < kSpeeds; ++s) {
      bins_[b][s].deviation_mps.merge(other.bins_[b][s].deviation_mps);
      bins_[b][s].squared_speeds += other.bins_[b][s].squared_speeds;
    }
  }
  for (std::size_t r = 0; r < kCarRanges; ++r) car_across_m_[r].merge(other.car_across_m_[r]);
}

double AzimuthNoise::azimuth_std_deg(std::size_t band) const {
  // Weighted line through variances y by mean squared speeds x.
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  std::size_t used = 0;
  for (const Bin& bin : bins_[band]) {
    if (bin.deviation_mps.size() < kLeastOfSpeed) continue;
    const auto weight = static_cast<double>(bin.deviation_mps.size());
    const double square = bin.squared_speeds / weight, std_mps = bin.deviation_mps.robust_std();
    n += weight;
    x += weight * square;
    y += weight * std_mps * std_mps;
    xx += weight * square * square;
    xy += weight * square * std_mps * std_mps;
    ++used;
  }
  if (used < 2) return kNoFigure;
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  return std::sqrt(std::max(0.0, slope)) / kDegree;
}

}  // namespace boresight::bench::realism
