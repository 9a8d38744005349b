#include "services/tracker/core/surroundings/surroundings.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

namespace {

double probability(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

/// Most urgent first: warnings, then by the probability of a collision.
bool is_more_urgent(const PathObject& a, const PathObject& b) {
  if (a.warning != b.warning) return a.warning > b.warning;
  if (a.collision_probability != b.collision_probability) return a.collision_probability > b.collision_probability;
  if (a.kind != b.kind) return a.kind < b.kind;
  return a.object_id < b.object_id;
}

}  // namespace

Surroundings::Surroundings(const VehicleConfig& vehicle, const SurroundingsParameters& parameters, double latest_scan_s,
                           double longest_gap_s)
    : parameters_(parameters),
      latest_scan_s_(latest_scan_s),
      longest_gap_s_(longest_gap_s),
      memory_(vehicle, parameters.stationary, parameters.obstacle),
      edges_(parameters.road_edge, parameters.stationary.behind_m),
      obstacles_(vehicle, parameters.obstacle, parameters.collision.front_m) {
  listed_.reserve(kMaxListed);
}

void Surroundings::step(const ClassifiedScan& scan, const TrackList& tracks) {
  move(scan);
  assess(tracks);
}

void Surroundings::move(const ClassifiedScan& scan) {
  const std::int64_t now_ns = scan.header.measurement_time_ns;
  double elapsed_s = has_time_ ? static_cast<double>(now_ns - time_ns_) * 1e-9 : 0.0;
  if (elapsed_s > longest_gap_s_ || elapsed_s < -latest_scan_s_) {
    memory_.clear();
    edges_.clear();
    obstacles_.clear();
    threats_.fill({});
    elapsed_s = 0.0;
  }
  has_time_ = true;
  time_ns_ = now_ns;
  elapsed_s_ = elapsed_s;
  const ScanGeometry& g = scan.geometry;
  const auto speed_mps = static_cast<double>(g.ego_speed_mps),
             yaw_rate_radps = static_cast<double>(g.ego_yaw_rate_radps);
  path_ = ego_path(speed_mps, yaw_rate_radps, static_cast<double>(g.ego_speed_std_mps),
                   static_cast<double>(g.ego_yaw_rate_std_radps), parameters_.collision.least_speed_mps);
  const geometry::EgoStep step = geometry::ego_step(speed_mps, yaw_rate_radps, elapsed_s);
  const double yaw_rad = yaw_rate_radps * elapsed_s;
  memory_.step(scan, step, yaw_rad, elapsed_s);
  edges_.step(memory_, path_, step, yaw_rad, elapsed_s);
  obstacles_.step(scan, memory_, path_, step, elapsed_s);
}

void Surroundings::assess(const TrackList& tracks) {
  listed_.clear();
  for (Threat& t : threats_) t.is_present = false;
  for (const PathObstacle& o : obstacles_.obstacles()) {
    MeetingObject meets;
    meets.position_m = o.position_m;
    meets.covariance.topLeftCorner<2, 2>() = o.covariance_m2;
    const double road_rad = path_.heading_rad(path_.place(o.position_m).along_m);
    const Eigen::Vector2d along(std::cos(road_rad), std::sin(road_rad)), across(-along.y(), along.x());
    meets.heading_rad = road_rad;
    meets.length_m = 2.0 * o.half_extent_m(along);
    meets.width_m = 2.0 * o.half_extent_m(across);
    PathObject out{};
    out.object_id = o.id;
    out.kind = PathObjectKind::kStationaryObstacle;
    out.update = o.is_detected ? TrackUpdate::kMeasured : TrackUpdate::kPredicted;
    out.age_s = static_cast<float>(o.age_s);
    out.existence_probability = static_cast<float>(probability(o.log_odds));
    list(out, meets);
  }
  for (std::size_t k = 0; k < tracks.number_of_tracks && k < kMaxTracks; ++k) {
    const Track& t = tracks.tracks[k];
    MeetingObject meets;
    for (Eigen::Index i = 0; i < 4; ++i) {
      for (Eigen::Index j = 0; j < 4; ++j) {
        meets.covariance(i, j) = static_cast<double>(
            t.covariance[static_cast<std::size_t>(i) * kTrackStateSize + static_cast<std::size_t>(j)]);
      }
    }
    meets.position_m = {static_cast<double>(t.position_vehicle_m[0]), static_cast<double>(t.position_vehicle_m[1])};
    meets.velocity_mps = {static_cast<double>(t.velocity_over_ground_mps[0]),
                          static_cast<double>(t.velocity_over_ground_mps[1])};
    meets.heading_rad = static_cast<double>(t.heading_rad);
    meets.length_m = static_cast<double>(t.length_m);
    meets.width_m = static_cast<double>(t.width_m);
    PathObject out{};
    out.object_id = t.tracking_id;
    out.kind = PathObjectKind::kTrack;
    out.update = t.update;
    out.age_s = t.age_s;
    out.existence_probability = t.status == TrackStatus::kConfirmed
                                    ? t.existence_probability * (1.0F - t.mirror_probability)
                                    : 0.0F;  // a tentative track is no reason to warn
    if (t.status == TrackStatus::kConfirmed) list(out, meets);
  }
  for (Threat& t : threats_) {
    if (!t.is_present) t = {};
  }
  std::sort(listed_.begin(), listed_.end(), is_more_urgent);
}

bool Surroundings::is_threat(const PathObject& object, const Meeting& m) const {
  const CollisionParameters& c = parameters_.collision;
  const bool is_oncoming = m.closing_mps > path_.speed_mps + c.oncoming_speed_mps;
  return path_.speed_mps >= c.least_speed_mps && m.time_s <= c.warning_time_s &&
         m.deceleration_mps2 >= c.warning_deceleration_mps2 && m.lateral_mps2 >= c.warning_lateral_mps2 &&
         static_cast<double>(object.existence_probability) >= c.least_existence &&
         m.probability >= (is_oncoming ? c.oncoming_probability : c.warning_probability);
}

double Surroundings::note_threat(std::uint32_t id, PathObjectKind kind) {
  Threat* free = nullptr;
  for (Threat& t : threats_) {
    if (t.id == id && t.kind == kind) {
      t.is_present = true;
      t.lasts_s += std::max(0.0, elapsed_s_);
      return t.lasts_s;
    }
    if (t.id == 0 && free == nullptr) free = &t;
  }
  if (free != nullptr) *free = {id, kind, 0.0, true};
  return 0.0;
}

void Surroundings::list(PathObject object, const MeetingObject& meets) {
  const CollisionParameters& c = parameters_.collision;
  Meeting m = meeting(meets, path_, c);
  if (!m.is_ahead || !(m.time_s <= c.horizon_s)) return;
  follow_road(edges_.course(m.place_m), c, m);
  const double hold_s = object.kind == PathObjectKind::kTrack ? c.hold_s : c.obstacle_hold_s;
  const double collision = m.probability * static_cast<double>(object.existence_probability);
  if (is_threat(object, m) && note_threat(object.object_id, object.kind) >= hold_s) object.warning = 1;
  if (collision < c.report_probability && object.warning == 0) return;
  object.collision_probability = static_cast<float>(collision);
  object.time_to_collision_s = static_cast<float>(m.time_s);
  object.time_to_collision_std_s = static_cast<float>(m.time_std_s);
  object.required_deceleration_mps2 = static_cast<float>(m.deceleration_mps2);
  object.path_offset_m = static_cast<float>(m.offset_m);
  object.path_offset_std_m = static_cast<float>(m.offset_std_m);
  object.length_m = static_cast<float>(m.length_m);
  object.width_m = static_cast<float>(m.width_m);
  object.position_vehicle_m = {static_cast<float>(meets.position_m.x()), static_cast<float>(meets.position_m.y())};
  object.velocity_over_ground_mps = {static_cast<float>(meets.velocity_mps.x()),
                                     static_cast<float>(meets.velocity_mps.y())};
  object.position_covariance_m2 = {static_cast<float>(meets.covariance(0, 0)),
                                   static_cast<float>(meets.covariance(0, 1)),
                                   static_cast<float>(meets.covariance(1, 1))};
  if (listed_.size() < listed_.capacity()) listed_.push_back(object);
}

void Surroundings::write(TrackList& out) const {
  edges_.write(out);
  const std::size_t count = std::min(listed_.size(), kMaxPathObjects);
  std::copy_n(listed_.begin(), count, out.path_objects.begin());
  out.number_of_path_objects = static_cast<std::uint32_t>(count);
  out.dropped_path_objects = static_cast<std::uint32_t>(listed_.size() - count);
  out.number_of_collision_warnings = static_cast<std::uint32_t>(
      std::count_if(out.path_objects.begin(), out.path_objects.begin() + static_cast<std::ptrdiff_t>(count),
                    [](const PathObject& o) { return o.warning != 0; }));
}

}  // namespace boresight::tracking
