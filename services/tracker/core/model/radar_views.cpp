// What the radar of a scan is to an object: whether it has it in view and can tell it from stationary reflectors, where
// its detections lie, and how many there are.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/model/radar_model.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

namespace {

/// P(standard normal < x)
double normal_cdf(double x) {
  if (std::abs(x) > kCertainDeviations) return x > 0.0 ? 1.0 : 0.0;
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

std::span<const double> RadarModel::class_probabilities(std::uint32_t label) const {
  const BoxMemory* object = memory(label);
  return object == nullptr ? std::span<const double>{} : object->probability;
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

Vector2<double> RadarModel::turn_at(const Vector2<double>& from_sensor_m, const Component<double>& c) const {
  const TurnParameters& turn = parameters_.box.turn;
  const double rate_radps = turn_rate_std_radps(turn, squared_norm(c.velocity_mps) + trace(c.velocity_covariance));
  return {-rate_radps * from_sensor_m.y, rate_radps * from_sensor_m.x};
}

RadarModel::Look RadarModel::look(const Component<double>& c) const {
  Look out;
  if (radar_ == nullptr) return out;
  View<double>& v = out.view;
  Sight& sight = out.sight;
  const DetectionParameters& p = parameters_.detection;
  const auto range_of = [&](const Vector2<double>& d) { return std::max(kLeastRange_m, std::sqrt(squared_norm(d))); };
  const Vector2<double> to_point = c.position_m - sensor_m_;
  v.noise_m2 = noise_at((1.0 / range_of(to_point)) * to_point, range_of(to_point));
  v.spread = p.spread;
  v.held = p.held_factor;
  v.source_more = parameters_.source.more;
  v.source_wander_m2 = parameters_.source.wander_m * parameters_.source.wander_m;
  v.evidence_share = parameters_.box.evidence_share;
  v.source_seen = c.source.radar >= 0 && c.source.radar != radar_index_ ? parameters_.source.other_radar : 1.0;
  v.range_rate_variance =
      radar_->range_rate_std_mps * radar_->range_rate_std_mps + p.body_range_rate_std_mps * p.body_range_rate_std_mps;
  v.turn_mps = turn_at(to_point, c);
  const std::optional<double> share = read_box(c, v);
  double by_azimuth = 1.0;
  if (share.has_value()) {
    // Of what is out of view there are no detections: their number says it.
    v.exposure = std::max(kLeastProbability, *share);
    sight.in_view = *share;
  } else {
    sight.in_view = by_azimuth = in_view(c);
  }
  Vector2<double> middle = to_point;
  for (std::size_t k = 0; k < v.number_of_readings; ++k) {
    middle = middle + v.readings[k].weight * v.readings[k].offset_m;
  }
  const double range_m = range_of(middle);
  const double range_std = std::sqrt(p.range_edge_m * p.range_edge_m + 0.5 * trace(c.position_covariance));
  const double by_range = normal_cdf((radar_->range_max_m - range_m) / range_std);
  sight.in_view *= by_range;
  sight.seems_moving = seems_moving((1.0 / range_m) * middle, c, v.range_rate_variance);
  v.detection_probability = p.detection_probability * by_azimuth * (by_range * sight.seems_moving);
  v.exposure *= exposure_at(range_m);
  return out;
}

Sight RadarModel::sight(const Component<double>& c, double likely) const {
  Sight out = look(c).sight;
  if (radar_ != nullptr && out.in_view >= likely) out.hidden_share = occlusion_.hidden_share(c.label, likely);
  return out;
}

std::optional<double> RadarModel::read_box(const Component<double>& c, View<double>& v) const {
  ObjectBoxes::Record* object = c.label == 0 ? nullptr : boxes_.see(c, v.noise_m2);
  if (object == nullptr) return std::nullopt;
  if (!object->readings) object->readings = readings_of(*object);
  const BoxReadings& box = *object->readings;
  if (box.number == 0) return std::nullopt;
  v.number_of_readings = box.number;
  v.readings = box.readings;
  v.range_rate_variance = radar_->range_rate_std_mps * radar_->range_rate_std_mps + box.range_rate_variance_m2ps2;
  return box.share_in_view;
}

BoxReadings RadarModel::readings_of(const ObjectBoxes::Record& object) const {
  BoxReadings box;
  if (!boxes_.estimator().knows_heading(object.memory)) return box;
  const double cosine = std::cos(object.memory.heading_rad), sine = std::sin(object.memory.heading_rad);
  const auto to_local = [&](const Eigen::Vector2d& b) {
    return Vector2<double>{cosine * b.x() - sine * b.y(), sine * b.x() + cosine * b.y()};
  };
  const auto covariance_to_local = [&](const Eigen::Matrix2d& b) {
    return congruent(Matrix2<double>{cosine, -sine, sine, cosine}, Symmetric2<double>{b(0, 0), b(0, 1), b(1, 1)});
  };
  // Classes of about a car's size are one reading by its moments. A truck is two: its detections come from one spot or
  // from all over it.
  constexpr auto kLong = static_cast<std::size_t>(extended_object::RoadUserClass::kTruck);
  const double least = parameters_.box.least_probability;
  Reading<double> shorter{0.0, {}, {}, false, {}};
  double share = 0.0, rate_variance = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < object.views.size(); ++k) {
    const ClassView& by_class = object.views[k];
    sum += by_class.probability;
    share += by_class.probability * by_class.reflections.share_in_view;
    rate_variance += by_class.probability * by_class.range_rate_variance_m2ps2;
    if (k == kLong) continue;
    shorter.weight += by_class.probability;
    shorter.offset_m = shorter.offset_m + by_class.probability * to_local(by_class.offset_m);
  }
  if (sum <= 0.0) return box;
  const ClassView& longer = object.views[kLong];
  const bool is_long_only = shorter.weight <= least;
  const double all = (is_long_only ? 0.0 : shorter.weight) + (longer.probability > least ? longer.probability : 0.0);
  if (!is_long_only) {
    shorter.offset_m = (1.0 / shorter.weight) * shorter.offset_m;
    for (std::size_t k = 0; k < object.views.size(); ++k) {
      if (k == kLong) continue;
      const ClassView& by_class = object.views[k];
      const Vector2<double> off = to_local(by_class.offset_m) - shorter.offset_m;
      shorter.covariance_m2 =
          shorter.covariance_m2 +
          (by_class.probability / shorter.weight) * (covariance_to_local(by_class.offset_covariance_m2) + outer(off));
    }
    shorter.weight /= all;
    box.readings[box.number++] = shorter;
  }
  if (longer.probability > least) {
    const Vector2<double> offset = to_local(longer.offset_m);
    const Symmetric2<double> covariance = covariance_to_local(longer.offset_covariance_m2),
                             scatter = covariance_to_local(longer.reflections.scatter_m2);
    const double spot = boxes_.estimator().table()[kLong].places.common_share;
    box.readings[box.number++] = {(1.0 - spot) * longer.probability / all, offset, covariance, true, scatter};
    box.readings[box.number++] = {spot * longer.probability / all, offset, covariance + scatter, false, {}};
  }
  box.range_rate_variance_m2ps2 = rate_variance / sum;
  box.share_in_view = share / sum;
  return box;
}

}  // namespace boresight::tracking
