// What the radar of a scan is to an object: whether it has it in view and can tell it from stationary reflectors, where
// its detections lie, and how many there are.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/model/radar_model.hpp"

namespace boresight::tracking {

namespace {

/// P(standard normal < x)
double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

}  // namespace

Symmetric2<double> RadarModel::noise_at(const Vector2<double>& sight, double range_m) const {
  const double along = radar_->range_std_m * radar_->range_std_m;
  const double across = range_m * range_m * radar_->azimuth_std_rad * radar_->azimuth_std_rad;
  return {along * sight.x * sight.x + across * sight.y * sight.y, (along - across) * sight.x * sight.y,
          along * sight.y * sight.y + across * sight.x * sight.x};
}

double RadarModel::exposure_at(double range_m) const {
  const DetectionParameters& d = parameters_.detection;
  return std::clamp(std::pow(d.count_range_m / range_m, d.count_power), d.count_least, d.count_most);
}

const BoxMemory* RadarModel::memory(std::uint32_t label) const {
  const ObjectBoxes::Record* object = boxes_.find(label);
  return object == nullptr ? nullptr : &object->memory;
}

double RadarModel::in_view(const Component<double>& c) const {
  const DetectionParameters& p = parameters_.detection;
  const Vector2<double> d = c.position_m - sensor_m_;
  const double range2_m2 = std::max(1.0, squared_norm(d)), variance = 0.5 * trace(c.position_covariance);
  const double azimuth_rad = geometry::wrap_angle(std::atan2(d.y, d.x) - facing_rad_);
  const double azimuth_std = std::sqrt(p.view_edge_rad * p.view_edge_rad + variance / range2_m2);
  return normal_cdf((radar_->half_view_rad - std::abs(azimuth_rad)) / azimuth_std);
}

double RadarModel::seems_moving(const Vector2<double>& sight, const Component<double>& c,
                                double range_rate_variance) const {
  const DetectionParameters& p = parameters_.detection;
  // An object whose range rate over ground is below the limit of the corrector's test is classified as stationary: it
  // is not detected as moving.
  const double by_azimuth =
      (sensor_velocity_mps_.x * sight.y - sensor_velocity_mps_.y * sight.x) * radar_->azimuth_std_rad;
  const double limit_mps =
      p.stationary_sigma * std::sqrt(radar_->range_rate_std_mps * radar_->range_rate_std_mps + by_azimuth * by_azimuth +
                                     p.motion_std_mps * p.motion_std_mps);
  const double rate_mps = dot(sight, c.velocity_mps);
  const double rate_std = std::sqrt(range_rate_variance + quadratic(c.velocity_covariance, sight));
  return normal_cdf((rate_mps - limit_mps) / rate_std) + normal_cdf((-rate_mps - limit_mps) / rate_std);
}

View<double> RadarModel::view(const Component<double>& c) const {
  View<double> v;
  if (radar_ == nullptr) return v;
  const DetectionParameters& p = parameters_.detection;
  constexpr double kNearest_m = 0.5;
  const auto range_of = [&](const Vector2<double>& d) { return std::max(kNearest_m, std::sqrt(squared_norm(d))); };
  const Vector2<double> to_point = c.position_m - sensor_m_;
  v.noise_m2 = noise_at((1.0 / range_of(to_point)) * to_point, range_of(to_point));
  v.spread = p.spread;
  v.held = p.held_factor;
  v.source_more = parameters_.source.more;
  v.evidence_share = parameters_.box.evidence_share;
  v.source_seen = c.source.radar >= 0 && c.source.radar != radar_index_ ? parameters_.source.other_radar : 1.0;
  v.range_rate_variance =
      radar_->range_rate_std_mps * radar_->range_rate_std_mps + p.body_range_rate_std_mps * p.body_range_rate_std_mps;
  const double share = read_box(c, v);
  v.detection_probability = p.detection_probability;
  if (share >= 0.0) {
    // Of what is out of view there are no detections: their number says it.
    constexpr double kLeastShare = 1e-3;
    v.exposure = std::max(kLeastShare, share);
  } else {
    v.detection_probability *= in_view(c);
  }
  Vector2<double> middle = to_point;
  for (std::size_t k = 0; k < v.number_of_readings; ++k) {
    middle = middle + v.readings[k].weight * v.readings[k].offset_m;
  }
  const double range_m = range_of(middle);
  const double range_std = std::sqrt(p.range_edge_m * p.range_edge_m + 0.5 * trace(c.position_covariance));
  v.detection_probability *= normal_cdf((radar_->range_max_m - range_m) / range_std) *
                             seems_moving((1.0 / range_m) * middle, c, v.range_rate_variance);
  v.exposure *= exposure_at(range_m);
  return v;
}

double RadarModel::read_box(const Component<double>& c, View<double>& v) const {
  constexpr double kUnknown = -1.0;
  const ObjectBoxes::Record* object = c.label == 0 ? nullptr : boxes_.see(c, v.noise_m2);
  if (object == nullptr || !boxes_.estimator().knows_heading(object->memory)) return kUnknown;
  const double cosine = std::cos(object->memory.heading_rad), sine = std::sin(object->memory.heading_rad);
  const auto to_local = [&](const Eigen::Vector2d& b) {
    return Vector2<double>{cosine * b.x() - sine * b.y(), sine * b.x() + cosine * b.y()};
  };
  const auto covariance_to_local = [&](const Eigen::Matrix2d& b) {
    return congruent(Matrix2<double>{cosine, -sine, sine, cosine}, Symmetric2<double>{b(0, 0), b(0, 1), b(1, 1)});
  };
  // Classes of about a car's size are one reading by its moments. A truck is two: its detections come from one spot or
  // from all over it.
  constexpr auto kLong = static_cast<std::size_t>(extended_object::RoadUserClass::kTruck);
  constexpr double kUnlikely = 0.01;
  Reading<double> shorter{0.0, {}, {}, false, {}};
  double share = 0.0, rate_variance = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < object->views.size(); ++k) {
    const ClassView& by_class = object->views[k];
    sum += by_class.probability;
    share += by_class.probability * by_class.reflections.share_in_view;
    rate_variance += by_class.probability * by_class.range_rate_variance_m2ps2;
    if (k == kLong) continue;
    shorter.weight += by_class.probability;
    shorter.offset_m = shorter.offset_m + by_class.probability * to_local(by_class.offset_m);
  }
  if (sum <= 0.0) return kUnknown;
  const ClassView& longer = object->views[kLong];
  const bool is_long_only = shorter.weight <= kUnlikely;
  const double all =
      (is_long_only ? 0.0 : shorter.weight) + (longer.probability > kUnlikely ? longer.probability : 0.0);
  v.number_of_readings = 0;
  if (!is_long_only) {
    shorter.offset_m = (1.0 / shorter.weight) * shorter.offset_m;
    for (std::size_t k = 0; k < object->views.size(); ++k) {
      if (k == kLong) continue;
      const ClassView& by_class = object->views[k];
      const Vector2<double> off = to_local(by_class.offset_m) - shorter.offset_m;
      shorter.covariance_m2 =
          shorter.covariance_m2 +
          (by_class.probability / shorter.weight) * (covariance_to_local(by_class.offset_covariance_m2) + outer(off));
    }
    shorter.weight /= all;
    v.readings[v.number_of_readings++] = shorter;
  }
  if (longer.probability > kUnlikely) {
    const Vector2<double> offset = to_local(longer.offset_m);
    const Symmetric2<double> covariance = covariance_to_local(longer.offset_covariance_m2),
                             scatter = covariance_to_local(longer.reflections.scatter_m2);
    const double spot = boxes_.estimator().table()[kLong].places.common_share;
    v.readings[v.number_of_readings++] = {(1.0 - spot) * longer.probability / all, offset, covariance, true, scatter};
    v.readings[v.number_of_readings++] = {spot * longer.probability / all, offset, covariance + scatter, false, {}};
  }
  v.range_rate_variance = radar_->range_rate_std_mps * radar_->range_rate_std_mps + rate_variance / sum;
  return share / sum;
}

}  // namespace boresight::tracking
