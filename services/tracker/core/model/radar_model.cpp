#include "services/tracker/core/model/radar_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "services/common/geometry/ego_step.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

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

RadarModel::RadarModel(const VehicleConfig& vehicle, const RadarModelParameters& parameters, std::size_t max_objects)
    : parameters_(parameters),
      boxes_(BoxEstimator(parameters.classes, parameters.box), parameters.box.road, max_objects),
      occlusion_(kMaxTracks) {
  // One in a thousand is longer than the mean by more than three deviations.
  for (const auto& c : parameters.classes) {
    reach_m_ = std::max(reach_m_, c.size.length_mean_m + 3.0 * c.size.length_std_m);
  }
  for (const RadarConfig& r : vehicle.radars) {
    const FieldOfView& f = r.field_of_view;
    const double half_rad = 0.5 * (f.azimuth_max_rad - f.azimuth_min_rad);
    radars_.push_back({r.id, 0.5 * (f.azimuth_max_rad + f.azimuth_min_rad), half_rad, f.range_max_m,
                       r.noise.range_std_m, r.noise.azimuth_std_rad, r.noise.range_rate_std_mps,
                       ClutterMap(parameters.clutter, half_rad, f.range_max_m), parameters.source.wide_prior,
                       parameters.source.wide_prior});
  }
  measurements_.reserve(kMaxDetections);
  places_.reserve(kMaxDetections);
  objects_.reserve(kMaxTracks);
  lobes_.reserve(kMaxTracks);
  by_range_.reserve(kMaxDetections);
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
    boxes_.clear();
  }
  elapsed_s_ = start.elapsed_s;
  move_axes(scan, start.elapsed_s);
  read_detections(scan);
  if (radar_ != nullptr) {
    find_rings();
    find_partners();
    add_side_lobes();
    add_wide_range_rates();
  }
  return start;
}

void RadarModel::move_axes(const ClassifiedScan& scan, double elapsed_s) {
  const auto speed_mps = static_cast<double>(scan.geometry.ego_speed_mps);
  const auto yaw_rate_radps = static_cast<double>(scan.geometry.ego_yaw_rate_radps);
  const geometry::EgoStep step = geometry::ego_step(speed_mps, yaw_rate_radps, elapsed_s);
  displacement_m_ = axes_.to_local({step.translation_m.x(), step.translation_m.y()});
  axes_.heading_rad = geometry::wrap_angle(axes_.heading_rad + yaw_rate_radps * elapsed_s);
  for (KnownObject& o : objects_) move(o.component, elapsed_s);
}

void RadarModel::read_detections(const ClassifiedScan& scan) {
  measurements_.clear();
  places_.clear();
  radar_ = nullptr;
  radar_index_ = -1;
  // A radar whose data are proven wrong sees nothing: neither detections nor empty space.
  if ((scan.flags & pipeline_flag::kDistrusted) != 0) return;
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
  boxes_.begin_scan({sensor_m_, facing_rad_, radar_->half_view_rad, parameters_.detection.view_edge_rad});
  const double time_s = static_cast<double>(time_ns_) * 1e-9;
  radar_->clutter.begin_scan(time_s);
  const double keep = std::exp(-std::abs(time_s - radar_->levels_time_s) / parameters_.clutter.level_memory_s);
  radar_->levels_time_s = time_s;
  radar_->wide_seen *= keep;
  radar_->wide_expected *= keep;
  radar_->wide_seen += (1.0 - keep) * parameters_.source.wide_prior;
  radar_->wide_expected += (1.0 - keep) * parameters_.source.wide_prior;
  radar_->strength_sum_db *= keep;
  radar_->strengths *= keep;
  for (std::uint32_t i = 0; i < scan.number_of_valid_detections && i < kMaxDetections; ++i) {
    if (scan.provenance[i] == Provenance::kUnknown || (scan.detection_flags[i] & corrected_flag::kMoving) == 0)
      continue;
    const auto rate_mps = static_cast<double>(scan.range_rate_over_ground_mps[i]);
    const Vector2<double> at{static_cast<double>(scan.x_vehicle_m[i]), static_cast<double>(scan.y_vehicle_m[i])};
    const auto azimuth_rad = static_cast<double>(scan.azimuth_vehicle_rad[i]);
    const Vector2<double> sight{std::cos(azimuth_rad), std::sin(azimuth_rad)};
    const auto ratio = static_cast<double>(scan.moving_log_likelihood_ratio[i]);
    if (!std::isfinite(at.x + at.y + sight.x + rate_mps + ratio + static_cast<double>(scan.range_m[i]))) continue;
    Measurement<double> z;
    z.position_m = axes_.to_local(at);
    z.sight = axes_.to_local(sight);
    z.range_rate_mps = rate_mps;
    z.moving = 1.0 / (1.0 + std::exp(-ratio));
    z.mirror = static_cast<double>(scan.probability(Provenance::kGhostType1, i) +
                                   scan.probability(Provenance::kGhostType2, i));
    const auto strength_db = static_cast<double>(scan.rcs_dbsm[i]);
    if ((scan.fields & scan_field::kRcs) != 0 && std::isfinite(strength_db)) {
      z.strength_db = strength_db;
      z.strengths = 1.0;
      radar_->strength_sum_db += strength_db;
      radar_->strengths += 1.0;
    }
    ClutterPlace place;
    place.range_m = static_cast<double>(scan.range_m[i]);
    // A radar that reaches farther than its configuration states has objects there in view, too.
    radar_->range_max_m = std::max(radar_->range_max_m, place.range_m);
    place.azimuth_share = geometry::wrap_angle(azimuth_rad + axes_.heading_rad - facing_rad_) / radar_->half_view_rad;
    place.range_rate_over_ground_mps = rate_mps;
    place.range_rate_mps = rate_mps - dot(z.sight, sensor_velocity_mps_);
    z.log_clutter = std::log(radar_->clutter.intensity(place)) + log_origin(ratio);
    measurements_.push_back(z);
    places_.push_back(place);
  }
  // Radars differ in what they state.
  if (radar_->strengths <= 0.0) return;
  const double usual_db = radar_->strength_sum_db / radar_->strengths;
  for (Measurement<double>& z : measurements_) z.strength_db -= z.strengths * usual_db;
}

void RadarModel::find_occlusion() {
  occlusion_.begin_scan(sensor_m_);
  for (const KnownObject& o : objects_) occlusion_.add(o.component.label, o.existence, boxes_.box(o.component));
}

double RadarModel::log_origin(double log_likelihood_ratio) const {
  const ClutterParameters& c = parameters_.clutter;
  return -c.origin_weight * std::clamp(log_likelihood_ratio + c.origin_offset, -c.origin_limit, c.origin_limit);
}

double RadarModel::predict(Component<double>& c, double elapsed_s) const {
  const double survival = move(c, elapsed_s);
  if (radar_ != nullptr) weigh_side_lobe(c);
  return survival;
}

double RadarModel::move(Component<double>& c, double elapsed_s) const {
  tracking::predict(c, parameters_.motion, elapsed_s);
  c.position_m = c.position_m - displacement_m_;
  const double time_s = std::max(0.0, elapsed_s);
  const double as_object = std::exp(-time_s / parameters_.object_life_s);
  const double as_source = std::exp(-time_s / parameters_.source.life_s);
  c.strengths *= std::exp(-time_s / parameters_.source.strength_memory_s);
  const double lasting = c.source.object + c.source.side_lobe + c.source.lasting_source;
  const double survival = lasting * as_object + std::max(0.0, 1.0 - lasting) * as_source;
  c.source.object *= as_object / survival;
  c.source.side_lobe *= as_object / survival;
  c.source.lasting_source *= as_object / survival;
  return survival;
}

bool RadarModel::are_linked(const Measurement<double>& a, const Measurement<double>& b) const {
  const double m = parameters_.birth.link_distance_m;
  return squared_norm(a.position_m - b.position_m) <= m * m &&
         std::abs(a.range_rate_mps - b.range_rate_mps) <= parameters_.birth.link_range_rate_mps;
}

void RadarModel::learn(std::span<const double> explained, std::span<const ObjectEstimate> objects) {
  note_objects(objects);
  boxes_.learn(objects, elapsed_s_, axes_.heading_rad);
  if (radar_ == nullptr) return;
  find_occlusion();
  for (std::size_t i = 0; i < explained.size() && i < places_.size(); ++i) {
    radar_->clutter.add(places_[i], std::max(0.0, 1.0 - explained[i]) * (1.0 - measurements_[i].wide_share));
  }
}

void RadarModel::note_objects(std::span<const ObjectEstimate> objects) {
  objects_.clear();
  for (const ObjectEstimate& e : objects) {
    if (objects_.size() == kMaxTracks) break;
    objects_.push_back(
        {*e.component, e.existence, e.source_existence * e.component->source.side_lobe, {}, 0.0, 0.0, 0.0});
  }
}

}  // namespace boresight::tracking
