#include "services/tracker/core/model/radar_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "services/common/geometry/ego_step.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();

/// P(standard normal < x)
double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

constexpr double kSlowest_mps = 0.3;  // about where the corrector's test of stationary detections ends
constexpr std::size_t kMaxKnownObjects = kMaxTracks;

}  // namespace

Matrix2<double> LocalAxes::rotation() const {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  return {c, -s, s, c};
}
Vector2<double> LocalAxes::to_local(const Vector2<double>& v) const {
  return rotation() * v;
}
Vector2<double> LocalAxes::to_vehicle(const Vector2<double>& v) const {
  return transpose(rotation()) * v;
}
Symmetric2<double> LocalAxes::to_vehicle(const Symmetric2<double>& s) const {
  return congruent(transpose(rotation()), s);
}
Matrix2<double> LocalAxes::to_vehicle(const Matrix2<double>& m) const {
  return transpose(rotation()) * m * rotation();
}

RadarModel::RadarModel(const VehicleConfig& vehicle, const RadarModelParameters& parameters) : parameters_(parameters) {
  for (const RadarConfig& r : vehicle.radars) {
    const FieldOfView& f = r.field_of_view;
    const double half_rad = 0.5 * (f.azimuth_max_rad - f.azimuth_min_rad);
    radars_.push_back({r.id, 0.5 * (f.azimuth_max_rad + f.azimuth_min_rad), half_rad, f.range_max_m,
                       r.noise.range_std_m, r.noise.azimuth_std_rad, r.noise.range_rate_std_mps,
                       ClutterMap(parameters.clutter, half_rad, f.range_max_m, kSlowest_mps)});
  }
  measurements_.reserve(kMaxDetections);
  places_.reserve(kMaxDetections);
  objects_.reserve(kMaxKnownObjects);
}

ScanStart RadarModel::begin_scan(const ClassifiedScan& scan) {
  ScanStart start;
  const std::int64_t now_ns = scan.header.measurement_time_ns;
  const double elapsed_s = has_time_ ? static_cast<double>(now_ns - time_ns_) * 1e-9 : 0.0;
  // A little back is a scan of another radar that finished late: it is used at its own time. More is a clock that was
  // set, or a recording that began again.
  start.restarted = elapsed_s > parameters_.longest_gap_s || elapsed_s < -parameters_.latest_scan_s;
  start.out_of_order = !start.restarted && elapsed_s < 0.0;
  start.elapsed_s = start.restarted ? 0.0 : elapsed_s;
  has_time_ = true;
  time_ns_ = now_ns;
  if (start.restarted) {
    axes_ = {};
    objects_.clear();
  }
  move_axes(scan, start.elapsed_s);
  read_detections(scan);
  add_side_lobes();
  return start;
}

void RadarModel::move_axes(const ClassifiedScan& scan, double elapsed_s) {
  const auto speed_mps = static_cast<double>(scan.geometry.ego_speed_mps);
  const auto yaw_rate_radps = static_cast<double>(scan.geometry.ego_yaw_rate_radps);
  const geometry::EgoStep step = geometry::ego_step(speed_mps, yaw_rate_radps, elapsed_s);
  displacement_m_ = axes_.to_local({step.translation_m.x(), step.translation_m.y()});
  axes_.heading_rad = geometry::wrap_angle(axes_.heading_rad + yaw_rate_radps * elapsed_s);
  for (KnownObject& o : objects_) o.position_m = o.position_m + elapsed_s * o.velocity_mps - displacement_m_;
}

void RadarModel::read_detections(const ClassifiedScan& scan) {
  measurements_.clear();
  places_.clear();
  radar_ = nullptr;
  for (std::size_t k = 0; k < radars_.size(); ++k) {
    if (radars_[k].id != scan.header.source_id) continue;
    radar_ = &radars_[k];
    radar_index_ = static_cast<int>(k);
  }
  if (radar_ == nullptr) return;
  const ScanGeometry& g = scan.geometry;
  sensor_m_ = axes_.to_local(
      {static_cast<double>(g.sensor_position_vehicle_m[0]), static_cast<double>(g.sensor_position_vehicle_m[1])});
  const double yaw_rad =
      std::atan2(static_cast<double>(g.sensor_to_vehicle[3]), static_cast<double>(g.sensor_to_vehicle[0]));
  facing_rad_ = axes_.heading_rad + yaw_rad + radar_->view_middle_rad;
  sensor_velocity_mps_ = axes_.to_local(
      {static_cast<double>(g.sensor_velocity_vehicle_mps[0]), static_cast<double>(g.sensor_velocity_vehicle_mps[1])});
  const double time_s = static_cast<double>(time_ns_) * 1e-9;
  radar_->clutter.begin_scan(time_s);
  const double keep = std::exp(-std::abs(time_s - radar_->moving_time_s) / parameters_.clutter.origin_memory_s);
  radar_->moving_time_s = time_s;
  constexpr double kPriorShare = 0.5;  // with the weight of one detection
  radar_->moving_sum = keep * radar_->moving_sum + (1.0 - keep) * kPriorShare;
  radar_->moving_count = keep * radar_->moving_count + (1.0 - keep);
  for (std::uint32_t i = 0; i < scan.number_of_valid_detections && i < kMaxDetections; ++i) {
    if (scan.provenance[i] == Provenance::kUnknown || (scan.detection_flags[i] & corrected_flag::kMoving) == 0)
      continue;
    const auto rate_mps = static_cast<double>(scan.range_rate_over_ground_mps[i]);
    const Vector2<double> at{static_cast<double>(scan.x_vehicle_m[i]), static_cast<double>(scan.y_vehicle_m[i])};
    const auto azimuth_rad = static_cast<double>(scan.azimuth_vehicle_rad[i]);
    const Vector2<double> sight{std::cos(azimuth_rad), std::sin(azimuth_rad)};
    if (!std::isfinite(at.x + at.y + sight.x + rate_mps)) continue;
    Measurement<double> z;
    z.position_m = axes_.to_local(at);
    z.sight = axes_.to_local(sight);
    z.range_rate_mps = rate_mps;
    z.mirror = static_cast<double>(scan.probability(Provenance::kGhostType1, i) +
                                   scan.probability(Provenance::kGhostType2, i));
    ClutterPlace place;
    place.range_m = static_cast<double>(scan.range_m[i]);
    place.azimuth_share = geometry::wrap_angle(azimuth_rad + axes_.heading_rad - facing_rad_) / radar_->half_view_rad;
    place.range_rate_over_ground_mps = rate_mps;
    place.range_rate_mps = rate_mps - dot(z.sight, sensor_velocity_mps_);
    const auto moving = static_cast<double>(scan.probability(Provenance::kMoving, i));
    z.log_clutter = std::log(radar_->clutter.intensity(place)) + log_origin(moving);
    radar_->moving_sum += moving;
    radar_->moving_count += 1.0;
    measurements_.push_back(z);
    places_.push_back(place);
  }
}

double RadarModel::log_origin(double p) const {
  const ClutterParameters& c = parameters_.clutter;
  const auto against = [](double share) {
    constexpr double kCertain = 1e-6;
    const double q = std::clamp(share, kCertain, 1.0 - kCertain);
    return std::log((1.0 - q) / q);
  };
  const double usual = against(radar_->moving_sum / radar_->moving_count);
  return c.origin_weight * std::clamp(against(p) - usual, -c.origin_limit, c.origin_limit);
}

void RadarModel::add_side_lobes() {
  if (radar_ == nullptr) return;
  // An object gives weaker detections at its own range and range rate at other azimuths: more clutter there.
  constexpr double kRateStd_mps = 0.4, kRangeStd_m = 1.0, kDeviations2 = 9.0, kOwn = 2.5, kLeastExistence = 0.5;
  constexpr double kNearest_m = 3.0;
  for (const KnownObject& o : objects_) {
    if (o.existence < kLeastExistence) continue;
    const Vector2<double> d = o.position_m - sensor_m_;
    const double range_m = std::sqrt(squared_norm(d));
    if (range_m > radar_->range_max_m || range_m <= 0.0) continue;
    const Vector2<double> sight = (1.0 / range_m) * d;
    const double rate_mps = dot(sight, o.velocity_mps);
    const double range_std_m =
        std::sqrt(kRangeStd_m * kRangeStd_m + parameters_.detection.spread * quadratic(o.extent_m2, sight));
    for (std::size_t i = 0; i < measurements_.size(); ++i) {
      Measurement<double>& z = measurements_[i];
      const double a = (places_[i].range_m - range_m) / range_std_m, b = (z.range_rate_mps - rate_mps) / kRateStd_mps;
      const double deviation2 = a * a + b * b;
      if (deviation2 > kDeviations2) continue;
      if (squared_norm(z.position_m - o.position_m) < kOwn * kOwn * range_std_m * range_std_m) continue;  // its own
      const double added = o.existence * parameters_.source.side_lobes * std::exp(-0.5 * deviation2) /
                           (2.0 * std::numbers::pi * range_std_m * kRateStd_mps) /
                           (2.0 * radar_->half_view_rad * std::max(kNearest_m, range_m));
      const double base = std::exp(z.log_clutter), was = z.side_lobe_share * base;
      z.on_ring = 1.0;
      z.log_clutter = std::log(base + added);
      z.side_lobe_share = (was + added) / (base + added);
    }
  }
}

double RadarModel::predict(Component<double>& c, double elapsed_s) const {
  tracking::predict(c, parameters_.motion, elapsed_s);
  c.position_m = c.position_m - displacement_m_;
  const double time_s = std::max(0.0, elapsed_s);
  const double as_object = std::exp(-time_s / parameters_.object_life_s);
  const double as_source = std::exp(-time_s / parameters_.source.life_s);
  const double lasting = c.source.object + c.source.side_lobe + c.source.lasting_source;
  const double survival = lasting * as_object + std::max(0.0, 1.0 - lasting) * as_source;
  c.source.object *= as_object / survival;
  c.source.side_lobe *= as_object / survival;
  c.source.lasting_source *= as_object / survival;
  return survival;
}

Symmetric2<double> RadarModel::noise_at(const Vector2<double>& sight, double range_m) const {
  const double along = radar_->range_std_m * radar_->range_std_m;
  const double across = range_m * range_m * radar_->azimuth_std_rad * radar_->azimuth_std_rad;
  return {along * sight.x * sight.x + across * sight.y * sight.y, (along - across) * sight.x * sight.y,
          along * sight.y * sight.y + across * sight.x * sight.x};
}

double RadarModel::exposure_at(double range_m) const {
  constexpr double kLeast = 0.3, kMost = 3.0;
  return std::clamp(std::pow(parameters_.detection.count_range_m / range_m, parameters_.detection.count_power), kLeast,
                    kMost);
}

View<double> RadarModel::view(const Component<double>& c) const {
  View<double> v;
  if (radar_ == nullptr) return v;
  const DetectionParameters& p = parameters_.detection;
  const Vector2<double> d = c.position_m - sensor_m_;
  constexpr double kNearest_m = 0.5;
  const double range_m = std::max(kNearest_m, std::sqrt(squared_norm(d)));
  const Vector2<double> sight = (1.0 / range_m) * d;
  const double azimuth_rad = geometry::wrap_angle(std::atan2(d.y, d.x) - facing_rad_);
  const double place_variance = 0.5 * trace(c.position_covariance);
  const double azimuth_std = std::sqrt(p.view_edge_rad * p.view_edge_rad + place_variance / (range_m * range_m));
  const double range_std = std::sqrt(p.range_edge_m * p.range_edge_m + place_variance);
  v.detection_probability = p.detection_probability *
                            normal_cdf((radar_->half_view_rad - std::abs(azimuth_rad)) / azimuth_std) *
                            normal_cdf((radar_->range_max_m - range_m) / range_std);
  const double rate_mps = dot(sight, c.velocity_mps);
  // Blind to what moves along the line of sight no more than a stationary reflector seems to.
  const double by_azimuth =
      (sensor_velocity_mps_.x * sight.y - sensor_velocity_mps_.y * sight.x) * radar_->azimuth_std_rad;
  const double stationary_std = std::sqrt(radar_->range_rate_std_mps * radar_->range_rate_std_mps +
                                          by_azimuth * by_azimuth + p.motion_std_mps * p.motion_std_mps);
  const double limit_mps = p.stationary_sigma * stationary_std;
  const double rate_std =
      std::sqrt(radar_->range_rate_std_mps * radar_->range_rate_std_mps +
                p.body_range_rate_std_mps * p.body_range_rate_std_mps + quadratic(c.velocity_covariance, sight));
  v.detection_probability *=
      normal_cdf((rate_mps - limit_mps) / rate_std) + normal_cdf((-rate_mps - limit_mps) / rate_std);
  v.exposure = exposure_at(range_m);
  v.noise_m2 = noise_at(sight, range_m);
  v.range_rate_variance =
      radar_->range_rate_std_mps * radar_->range_rate_std_mps + p.body_range_rate_std_mps * p.body_range_rate_std_mps;
  v.spread = p.spread;
  v.held = p.held_factor;
  v.source_more = parameters_.source.more;
  v.source_seen = c.source.radar >= 0 && c.source.radar != radar_index_ ? parameters_.source.other_radar : 1.0;
  return v;
}

void RadarModel::begin_group(std::span<const Measurement<double>> group, std::span<const Prediction<double>> objects,
                             std::span<const double> existence) {
  group_objects_ = objects;
  group_existence_ = existence;
  if (group.empty() || radar_ == nullptr) return;
  Vector2<double> middle;
  for (const auto& z : group) middle = middle + (1.0 / static_cast<double>(group.size())) * z.position_m;
  const DetectionParameters& d = parameters_.detection;
  const BirthParameters& b = parameters_.birth;
  constexpr double kFar_m = 30.0, kDof = 9.0, kNearest_m = 0.5;
  View<double> v;
  const Vector2<double> sight_m = middle - sensor_m_;
  const double range_m = std::max(kNearest_m, std::sqrt(squared_norm(sight_m)));
  v.detection_probability = d.detection_probability;
  v.exposure = exposure_at(range_m);
  v.noise_m2 = noise_at((1.0 / range_m) * sight_m, range_m);
  v.range_rate_variance =
      radar_->range_rate_std_mps * radar_->range_rate_std_mps + d.body_range_rate_std_mps * d.body_range_rate_std_mps;
  v.spread = d.spread;
  v.source_more = parameters_.source.more;
  const std::array kinds = {b.slow, b.any, b.traffic};
  for (std::size_t k = 0; k < kBirthKinds; ++k) {
    Component<double> c;
    c.position_m = middle;
    c.rate_shape = d.count_shape;
    c.rate_inverse_scale = d.count_shape / d.count;
    c.position_covariance = {kFar_m * kFar_m, 0.0, kFar_m * kFar_m};
    const double variance = kinds[k].speed_std_mps * kinds[k].speed_std_mps;
    c.velocity_covariance = {variance, 0.0, variance};
    if (kinds[k].with_traffic) c.velocity_mps = sensor_velocity_mps_;
    c.extent_dof = kDof;
    const double scale = (kDof - 6.0) * b.half_length_m * b.half_length_m;
    c.extent_scale = {scale, 0.0, scale};
    // The density of the badly known place is taken away again.
    newborn_[k] = {c, Prediction<double>(c, v),
                   std::log(kinds[k].density_per_m2) + std::log(2.0 * std::numbers::pi * kFar_m * kFar_m)};
  }
}

RadarModel::NewbornWeights RadarModel::newborn_weights(const Cell<double>& cell) {
  const BirthParameters& b = parameters_.birth;
  const SourceParameters& s = parameters_.source;
  const double f = 1.0 / cell.n;
  const Vector2<double> mean = cell.mean();
  double claimed = 0.0;
  for (std::size_t l = 0; l < group_objects_.size(); ++l) {
    const Prediction<double>& p = group_objects_[l];
    const Vector2<double> d = mean - p.position_m();
    const double speed_mps = std::sqrt(squared_norm(p.velocity_mps()));
    const Vector2<double> along = speed_mps > 0.0 ? (1.0 / speed_mps) * p.velocity_mps() : Vector2<double>{1.0, 0.0};
    const Vector2<double> half = taken_m(speed_mps, quadratic(p.extent_m2(), along));
    const double x = dot(d, along) / half.x, y = (along.x * d.y - along.y * d.x) / half.y;
    // The chance that the place lies in what the object takes, falling off about its edge; the range rates must agree.
    const double r2 = x * x + y * y;
    const double mean_rate = dot(cell.sight_rate, p.velocity_mps()) * f;
    const double deviation =
        (cell.rate_squares * f - 2.0 * mean_rate + quadratic(cell.sight_squares, p.velocity_mps()) * f) /
        (p.range_rate_variance() + quadratic(p.velocity_covariance(), along));
    claimed = std::max(claimed, group_existence_[l] * std::exp(-0.7 * r2 * r2 - 0.5 * deviation / b.same_speed_chi2));
  }
  constexpr double kLeastFree = 1e-6, kLeastShare = 1e-12;
  const double log_free = std::log(std::max(kLeastFree, 1.0 - claimed));
  NewbornWeights w;
  std::array<double, kBirthKinds> log_p{};
  for (std::size_t k = 0; k < kBirthKinds; ++k) {
    newborn_[k].prediction.move_to(mean);
    log_p[k] = newborn_[k].prediction.log_likelihood(cell);
    w.object[k] = log_p[k] + newborn_[k].log_density + log_free;
  }
  // A source of clutter lies where clutter is, and its range rate is as clutter's: the density of an object's range
  // rate is taken away, that of the clutter put in its place.
  Newborn& any = newborn_[1];
  const double variance = b.any.speed_std_mps * b.any.speed_std_mps + any.prediction.range_rate_variance();
  const double log_rate = -0.5 * std::log(2.0 * std::numbers::pi * variance) - 0.5 * cell.rate_squares * f / variance;
  const double flat = log_p[1] + any.log_density - std::log(b.any.density_per_m2) + cell.log_clutter * f - log_rate;
  w.source = s.share > 0.0 ? flat + std::log(s.share) + any.prediction.log_source_ratio(cell.n) : kNothing;
  w.side_lobe = s.side_lobes > 0.0 && s.side_lobe_birth > 0.0
                    ? flat + std::log(s.side_lobe_birth * std::max(kLeastShare, cell.side_lobe_share * f))
                    : kNothing;
  w.top = std::max(w.source, w.side_lobe);
  for (const double o : w.object) w.top = std::max(w.top, o);
  w.sum = std::exp(w.source - w.top) + std::exp(w.side_lobe - w.top);
  for (const double o : w.object) w.sum += std::exp(o - w.top);
  return w;
}

double RadarModel::log_newborn(const Cell<double>& cell) {
  const NewbornWeights w = newborn_weights(cell);
  return w.top + std::log(w.sum);
}

Component<double> RadarModel::newborn(const Cell<double>& cell) {
  const NewbornWeights w = newborn_weights(cell);
  std::array<Component<double>, kBirthKinds> updated;
  std::array<WeightedComponent<double>, kBirthKinds> mixture;
  double object = 0.0;
  for (std::size_t k = 0; k < kBirthKinds; ++k) {
    Component<double> at = newborn_[k].component;
    at.position_m = cell.mean();
    updated[k] = newborn_[k].prediction.updated(at, cell);
    const double weight = std::exp(w.object[k] - w.top);
    object += weight;
    mixture[k] = {weight + 1e-12, &updated[k]};  // a sum of zero cannot be normalised
  }
  Component<double> c = merge<double>(mixture);
  c.source.object = object / w.sum;
  c.source.side_lobe = std::exp(w.side_lobe - w.top) / w.sum;
  c.source.lasting_source = std::exp(w.source - w.top) / w.sum * parameters_.source.lasting_share;
  c.source.radar = radar_index_;
  c.mirror = cell.mirror / cell.n;
  return c;
}

Vector2<double> RadarModel::taken_m(double speed_mps, double extent_along_m2) const {
  const BirthParameters& b = parameters_.birth;
  // From one end of a vehicle to the other; of a long one by its extent.
  const double length_m = std::max(b.vehicle_length_m, 2.0 * std::sqrt(extent_along_m2));
  const double share = speed_mps * speed_mps / (speed_mps * speed_mps + b.vehicle_speed_mps * b.vehicle_speed_mps);
  return {b.person_m + share * (length_m - b.person_m), b.person_m + share * (b.vehicle_width_m - b.person_m)};
}

bool RadarModel::are_one(const Component<double>& a, const Component<double>& b) const {
  const Vector2<double> d = a.position_m - b.position_m;
  const Vector2<double> v = 0.5 * (a.velocity_mps + b.velocity_mps);
  const double speed_mps = std::sqrt(squared_norm(v));
  constexpr double kFar_m = 30.0;
  if (squared_norm(d) > kFar_m * kFar_m) return false;
  const Vector2<double> along = speed_mps > 0.0 ? (1.0 / speed_mps) * v : Vector2<double>{1.0, 0.0};
  const Vector2<double> half = taken_m(speed_mps, std::max(quadratic(extent(a), along), quadratic(extent(b), along)));
  const double x = dot(d, along) / half.x, y = (along.x * d.y - along.y * d.x) / half.y;
  if (x * x > 1.0 || y * y > 1.0) return false;
  const Symmetric2<double> apart = a.velocity_covariance + b.velocity_covariance;
  return quadratic(inverse(apart), a.velocity_mps - b.velocity_mps) < parameters_.birth.same_speed_chi2;
}

bool RadarModel::are_linked(const Measurement<double>& a, const Measurement<double>& b) const {
  const double m = parameters_.birth.link_distance_m;
  return squared_norm(a.position_m - b.position_m) <= m * m &&
         std::abs(a.range_rate_mps - b.range_rate_mps) <= parameters_.birth.link_range_rate_mps;
}

void RadarModel::learn(std::span<const double> explained, std::span<const ObjectEstimate> objects) {
  note_objects(objects);
  if (radar_ == nullptr) return;
  for (std::size_t i = 0; i < explained.size() && i < places_.size(); ++i) {
    radar_->clutter.add(places_[i], std::max(0.0, 1.0 - explained[i]));
  }
}

void RadarModel::note_objects(std::span<const ObjectEstimate> objects) {
  objects_.clear();
  for (const ObjectEstimate& e : objects) {
    if (objects_.size() == kMaxKnownObjects) break;
    objects_.push_back({e.component->position_m, e.component->velocity_mps, extent(*e.component), e.existence});
  }
}

}  // namespace boresight::tracking
