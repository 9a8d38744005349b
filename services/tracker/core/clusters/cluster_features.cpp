#include "services/tracker/core/clusters/cluster_features.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::tracking {

namespace {

[[nodiscard]] bool counts(const ClusterPoint& point) {
  return point.weight > 0.0 && std::isfinite(point.weight + point.position_m.x + point.position_m.y);
}

/// Weighted moments of numbers, taken relative to the first one so that large values do not cancel.
class Moments {
 public:
  void add(double value, double weight) {
    if (!std::isfinite(value)) return;
    if (number_ <= 0.0) first_ = least_ = largest_ = value;
    const double from_first = value - first_;
    number_ += weight;
    sum_ += weight * from_first;
    squares_ += weight * from_first * from_first;
    least_ = std::min(least_, value);
    largest_ = std::max(largest_, value);
  }
  [[nodiscard]] ClusterStatistics statistics() const {
    if (number_ <= 0.0) return {};
    const double mean = sum_ / number_;
    return {number_, first_ + mean, std::sqrt(std::max(0.0, squares_ / number_ - mean * mean)), least_, largest_};
  }

 private:
  double number_ = 0.0, first_ = 0.0, sum_ = 0.0, squares_ = 0.0, least_ = 0.0, largest_ = 0.0;
};

template <typename Value>
[[nodiscard]] ClusterStatistics statistics_of(std::span<const ClusterPoint> points, const Value& value) {
  Moments moments;
  for (const ClusterPoint& point : points) {
    if (counts(point)) moments.add(value(point), point.weight);
  }
  return moments.statistics();
}

[[nodiscard]] double extent(const ClusterStatistics& s) {
  return s.largest - s.least;
}

/// Angle of the longest axis of a covariance; `otherwise` where all directions are alike.
[[nodiscard]] double principal_axis(const Symmetric2<double>& c, double otherwise_rad) {
  constexpr auto kAlike = static_cast<double>(std::numeric_limits<float>::epsilon());
  const double difference = c.xx - c.yy;
  if (std::hypot(difference, 2.0 * c.xy) <= kAlike * (c.xx + c.yy)) return otherwise_rad;
  return 0.5 * std::atan2(2.0 * c.xy, difference);
}

struct Plane {
  ClusterStatistics x, y;
  Symmetric2<double> covariance_m2;
  double sight_rad = 0.0;  // of the mean line of sight
};

[[nodiscard]] Plane plane_of(std::span<const ClusterPoint> points) {
  Plane plane;
  plane.x = statistics_of(points, [](const ClusterPoint& p) { return p.position_m.x; });
  plane.y = statistics_of(points, [](const ClusterPoint& p) { return p.position_m.y; });
  if (plane.x.number <= 0.0) return plane;
  double xy = 0.0;
  Vector2<double> sight;
  for (const ClusterPoint& p : points) {
    if (!counts(p)) continue;
    xy += p.weight * (p.position_m.x - plane.x.mean) * (p.position_m.y - plane.y.mean);
    sight = sight + p.weight * p.sight;
  }
  plane.covariance_m2 = {plane.x.std * plane.x.std, xy / plane.x.number, plane.y.std * plane.y.std};
  plane.sight_rad = std::atan2(sight.y, sight.x);
  return plane;
}

[[nodiscard]] ClusterFeatures features_of(std::span<const ClusterPoint> points, const Plane& plane, double axis_rad) {
  ClusterFeatures f;
  f.points = plane.x.number;
  f.centre_m = {plane.x.mean, plane.y.mean};
  if (f.points <= 0.0) return f;
  const double c = std::cos(axis_rad), s = std::sin(axis_rad);
  const ClusterStatistics along = statistics_of(points, [&](const ClusterPoint& p) {
    return c * (p.position_m.x - plane.x.mean) + s * (p.position_m.y - plane.y.mean);
  });
  const ClusterStatistics across = statistics_of(points, [&](const ClusterPoint& p) {
    return -s * (p.position_m.x - plane.x.mean) + c * (p.position_m.y - plane.y.mean);
  });
  f.axis_rad = axis_rad;
  f.covariance_m2 = plane.covariance_m2;
  f.length_m = extent(along);
  f.width_m = extent(across);
  f.along_std_m = along.std;
  f.across_std_m = across.std;
  f.area_m2 = f.length_m * f.width_m;
  f.elevation_m = statistics_of(points, [](const ClusterPoint& p) { return p.height_m; });
  f.height_m = extent(f.elevation_m);
  f.volume_m3 = f.area_m2 * f.height_m;
  f.strength_db = statistics_of(points, [](const ClusterPoint& p) { return p.strength_db; });
  f.snr_db = statistics_of(points, [](const ClusterPoint& p) { return p.snr_db; });
  f.range_rate_mps = statistics_of(points, [](const ClusterPoint& p) { return p.range_rate_mps; });
  f.range_m = statistics_of(points, [](const ClusterPoint& p) { return p.range_m; });
  f.depth_m = extent(f.range_m);
  return f;
}

}  // namespace

ClusterFeatures cluster_features(std::span<const ClusterPoint> points, double heading_rad) {
  return features_of(points, plane_of(points), heading_rad);
}

ClusterFeatures cluster_features(std::span<const ClusterPoint> points) {
  const Plane plane = plane_of(points);
  return features_of(points, plane, principal_axis(plane.covariance_m2, plane.sight_rad));
}

}  // namespace boresight::tracking
