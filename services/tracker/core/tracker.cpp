#include "services/tracker/core/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/geometry/ego_step.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/birth.hpp"
#include "services/tracker/core/duplicates.hpp"
#include "services/tracker/core/flank.hpp"
#include "services/tracker/core/heading.hpp"
#include "services/tracker/core/images.hpp"
#include "services/tracker/core/life.hpp"
#include "services/tracker/core/pieces.hpp"
#include "services/tracker/core/seen_centre.hpp"
#include "services/tracker/core/stopped.hpp"
#include "services/tracker/core/track_message.hpp"
#include "services/tracker/core/visibility.hpp"
#include "services/tracker/core/wheels.hpp"

namespace boresight::tracking {

namespace {

/// Of what a cluster's range rate says of its body, beside the sensor's noise. People are nothing but limbs, and of
/// what is new it is not known what is a wheel; but a vehicle is rigid, and what is left of wheels in the mean is a
/// share of the speed.
double range_rate_std_mps(const TrackedObject& track, const RulesConfig& config) {
  constexpr double kOfSpeed = 0.04, kRigid = 0.5;
  if (!track.confirmed || track.extent.is_small) return config.range_rate_std_mps;
  const double of_wheels = kOfSpeed * track.state.mean.segment<2>(2).norm();
  return std::clamp(of_wheels, kRigid * config.range_rate_std_mps, config.range_rate_std_mps);
}

/// The cluster as a measurement of the centre of the box that it is seen of.
PositionRate measurement_of(const Cluster& cluster, const TrackedObject& track, const Eigen::Vector2d& sensor,
                            const RulesConfig& config) {
  // What the faces say errs the same way from scan to scan, and the more the larger they are.
  constexpr double kLeast = 0.5;  // of a person who walks
  const double share = std::clamp(track.extent.length_m / Extent::kCarLength_m, kLeast, 1.0);
  const SeenCentre seen = seen_centre(cluster, track.extent, track.state.mean.head<2>(),
                                      track.state.covariance.topLeftCorner<2, 2>(), sensor);
  PositionRate m;
  m.value << seen.at_m, cluster.range_rate_over_ground_mps;
  m.covariance.setZero();
  m.covariance.topLeftCorner<2, 2>() =
      seen.covariance_m2 + share * share * config.centre_std_m * config.centre_std_m * Eigen::Matrix2d::Identity();
  const double std = range_rate_std_mps(track, config);
  m.covariance(2, 2) = cluster.range_rate_variance + std * std;
  m.line_of_sight = cluster.mean_sight;
  return m;
}

/// Whether the range rate alone is within the gate; else nothing need be asked about the place.
bool rate_fits(const Cluster& cluster, const KinematicState& state, const RulesConfig& config) {
  const Eigen::Vector2d& sight = cluster.mean_sight;
  const double off_mps = cluster.range_rate_over_ground_mps - sight.dot(state.mean.segment<2>(2));
  const double variance = cluster.range_rate_variance + config.range_rate_std_mps * config.range_rate_std_mps +
                          sight.dot(state.covariance.block<2, 2>(2, 2) * sight);
  return off_mps * off_mps < config.gate_chi2 * variance;
}

/// Whether the cluster is another vehicle's and tells nothing of this track, even where the other is given another
/// cluster, of a part farther off: it lies on one that has long been tracked, beside this one, and moves rather as that
/// one does; or near one, and moves as that one does and clearly not as this one.
bool is_of_another(const Cluster& cluster, const TrackedObject& track, std::span<const TrackedObject> tracks) {
  constexpr double kOn_m = 0.5, kLong_s = 2.0;
  constexpr double kNear_m = 2.0, kNew_s = 0.5, kClearly_mps = 0.2;
  const auto is_at = [&cluster](const TrackedObject& t, double margin_m) {
    return t.confirmed && !t.extent.is_small && t.extent.contains(t.state.mean.head<2>(), cluster.position_m, margin_m);
  };
  const auto off_mps = [&cluster](const TrackedObject& t) {
    return std::abs(cluster.range_rate_over_ground_mps - cluster.mean_sight.dot(t.state.mean.segment<2>(2)));
  };
  const double own_mps = off_mps(track);
  const bool has_own_place = track.confirmed && !track.extent.is_small && !is_at(track, kOn_m);
  return std::any_of(tracks.begin(), tracks.end(), [&](const TrackedObject& other) {
    if (&other == &track || other.age_s < kNew_s) return false;
    if (is_at(other, kNear_m) && off_mps(other) < own_mps - kClearly_mps) return true;
    return has_own_place && other.age_s >= kLong_s && is_at(other, kOn_m) && off_mps(other) < own_mps;
  });
}

/// Where the track is, as the owners of detections are asked for.
KnownPlace place_of(const TrackedObject& track) {
  const Extent& e = track.extent;
  return {track.state.mean.head<2>(),
          {std::cos(e.heading_rad), std::sin(e.heading_rad)},
          {0.5 * e.length_m, 0.5 * e.width_m},
          e.is_small,
          track.state.mean.segment<2>(2),
          track.state.covariance.topLeftCorner<2, 2>(),
          track.state.covariance.block<2, 2>(2, 2)};
}

/// Whether the cluster is surely of something beside the track's vehicle, one that has long been tracked.
bool drives_beside(const Cluster& cluster, const TrackedObject& track) {
  constexpr double kLong_s = 2.0;
  if (track.extent.is_small || track.age_s < kLong_s) return false;
  const Eigen::Vector2d left(-cluster.mean_sight.y(), cluster.mean_sight.x());
  const Seen seen{cluster.position_m,
                  cluster.mean_sight,
                  std::sqrt(cluster.mean_sight.dot(cluster.covariance_m2 * cluster.mean_sight)),
                  std::sqrt(left.dot(cluster.covariance_m2 * left)),
                  cluster.range_rate_over_ground_mps,
                  std::sqrt(cluster.range_rate_variance)};
  return is_beside(seen, place_of(track));
}

/// The heading of a vehicle, and its box along it.
void follow_heading(TrackedObject& track, const Cluster& cluster, const Eigen::Vector2d& sensor, const OwnRoad& road) {
  Heading& heading = track.state.heading;
  const bool is_long = track.extent.object_class() == ObjectClass::kTruck;
  if (heading.known) {
    hold_to_heading(track.state);
    if (const auto turn = turn_of_flank(cluster, heading.rad, sensor, is_long)) measure_heading(track.state, *turn);
    track.extent.follow_heading(heading.rad);
    return;
  }
  begin_heading(track.state);
  if (!heading.known) {
    const auto turn = turn_of_flank(cluster, track.extent.heading_rad, sensor, is_long);
    if (turn) begin_heading(track.state, track.extent.heading_rad, *turn);
  }
  if (!heading.known) {
    const auto road_rad = road.heading_rad(track.state.mean.head<2>());
    if (road_rad) begin_heading(track.state, *road_rad);
  }
  // Until then the box lay along the line of sight.
  if (heading.known) track.extent.heading_rad = heading.rad;
}

}  // namespace

Tracker::Tracker(const VehicleConfig& vehicle, const RulesConfig& config)
    : vehicle_(vehicle), config_(config), clusterer_(config) {
  tracks_.reserve(kMaxTracks);
  for (const RadarConfig& radar : vehicle_.radars) {
    const Eigen::Vector2d at(radar.mounting_pose.position_m[0], radar.mounting_pose.position_m[1]);
    radars_low_m_ = radars_low_m_.cwiseMin(at);
    radars_high_m_ = radars_high_m_.cwiseMax(at);
  }
}

StepResult Tracker::step(const ClassifiedScan& scan) {
  StepResult result;
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  double elapsed_s = static_cast<double>(time_ns - time_ns_) * 1e-9;
  // A little back is a scan of another radar that came late; more is a clock that was set, or a recording that began
  // again.
  constexpr double kLongestPause_s = 2.0, kLatest_s = 0.3;
  if (elapsed_s > kLongestPause_s || elapsed_s < -kLatest_s) {
    result.restarted = time_ns_ != 0;
    tracks_.clear();
    elapsed_s = 0.0;
  } else if (elapsed_s < 0.0) {
    result.out_of_order = true;
    elapsed_s = 0.0;
  }
  if (!result.out_of_order) time_ns_ = time_ns;
  flags_ = scan.flags;
  dropped_tracks_ = 0;

  predict_all(elapsed_s, scan.geometry);
  road_ = OwnRoad(scan.geometry);
  const bool has_elevation = (scan.flags & pipeline_flag::kNoElevation) == 0;
  const std::span<const Cluster> clusters = join_parts(clusterer_.find(scan, known()));
  result.dropped_detections = clusterer_.dropped();
  const Eigen::Vector2d sensor(scan.geometry.sensor_position_vehicle_m[0], scan.geometry.sensor_position_vehicle_m[1]);
  assign(clusters, sensor, has_elevation);
  push_off(scan.geometry.ego_speed_mps);
  keep_stopped(tracks_, scan);
  watch_pieces(tracks_, sensor);
  judge(scan);
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (cluster_used_[c] || clusters[c].realness < config_.start_realness) continue;
    start_track(clusters[c], sensor, has_elevation);
  }
  remove_duplicates(tracks_, sensor, config_);
  result.dropped_objects = dropped_tracks_;
  return result;
}

void Tracker::predict_all(double elapsed_s, const ScanGeometry& geometry) {
  const geometry::EgoStep ego = geometry::ego_step(geometry.ego_speed_mps, geometry.ego_yaw_rate_radps, elapsed_s);
  const double turn = static_cast<double>(geometry.ego_yaw_rate_radps) * elapsed_s;
  // The signal's error, of its steps and its bias, stays the same for some seconds: as if it walked.
  constexpr double kStays_s = 3.0;
  const auto stated = static_cast<double>(geometry.ego_yaw_rate_std_radps);
  const double turn_std_radps = stated > 0.0 ? stated : vehicle_.ego.yaw_rate_std_radps;
  for (TrackedObject& track : tracks_) {
    predict(track.state, elapsed_s, config_.jerk_std_mps3, ego,
            track.extent.is_small ? Moves::kAnyWay : Moves::kAsVehicle);
    blur_own_turn(track.state, turn_std_radps * turn_std_radps * kStays_s * elapsed_s);
    if (track.state.heading.known) predict_heading(track.state, elapsed_s, turn);
    track.extent.heading_rad = geometry::wrap_angle(track.extent.heading_rad - turn);
    track.age_s += elapsed_s;
    track.since_update_s += elapsed_s;
    track.detections = 0;
  }
}

std::span<const KnownPlace> Tracker::known() {
  // Younger ones may be parts of one vehicle.
  constexpr double kNew_s = 0.5;
  std::size_t count = 0;
  for (const TrackedObject& track : tracks_) {
    const Extent& e = track.extent;
    if (!track.confirmed || (!e.is_small && track.age_s < kNew_s)) continue;
    known_[count++] = place_of(track);
  }
  return {known_.data(), count};
}

std::span<const Cluster> Tracker::join_parts(std::span<const Cluster> clusters) {
  // A long vehicle reflects at its ends and little between: what lies in its box and moves with it is one thing.
  constexpr double kMargin_m = 0.5;
  for (const TrackedObject& track : tracks_) {
    if (!track.confirmed || track.extent.is_small) continue;
    const auto is_part = [&](const Cluster& cluster) {
      const double rate = cluster.mean_sight.dot(track.state.mean.segment<2>(2));
      return track.extent.contains(track.state.mean.head<2>(), cluster.position_m, kMargin_m) &&
             std::abs(cluster.range_rate_over_ground_mps - rate) < config_.cluster_max_range_rate_spread_mps;
    };
    std::size_t first = 0;
    while (first < clusters.size() && !is_part(clusters[first])) ++first;
    for (std::size_t c = first + 1; c < clusters.size();) {
      if (is_part(clusters[c])) {
        clusters = clusterer_.join(first, c);
      } else {
        ++c;
      }
    }
  }
  return clusters;
}

void Tracker::assign(std::span<const Cluster> clusters, const Eigen::Vector2d& sensor, bool has_elevation) {
  cluster_used_.fill(false);
  assignment_.reset(tracks_.size(), clusters.size(), config_.gate_chi2);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      if (!rate_fits(clusters[c], tracks_[t].state, config_)) continue;
      const Distance d = distance(tracks_[t].state, measurement_of(clusters[c], tracks_[t], sensor, config_));
      if (d.squared >= config_.gate_chi2 || is_of_another(clusters[c], tracks_[t], tracks_)) continue;
      // A new track is unsure of everything and fits anything: the confirmed one has the right of way.
      const double preference = tracks_[t].confirmed ? 0.0 : 0.25 * (config_.gate_chi2 - d.squared);
      // Twice the negative logarithm of being real, as d² is of the place: what may be a ghost comes second.
      assignment_.set(t, c, d.squared + preference - 2.0 * std::log(clusters[c].realness));
    }
  }
  assignment_.solve();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const std::int32_t column = assignment_.column_of(t);
    if (column < 0) continue;
    const Cluster& cluster = clusters[static_cast<std::size_t>(column)];
    TrackedObject& track = tracks_[t];
    if (!follow(track, cluster, sensor)) continue;
    cluster_used_[static_cast<std::size_t>(column)] = true;
    update_extent(track, cluster, sensor, has_elevation);
    track.slow = track.state.mean.segment<2>(2).norm() < kSlow_mps;
    track.since_update_s = 0.0;
    track.detections = cluster.number_of_detections;
    track.realness = cluster.realness;
  }
  // What lies within a confirmed track's box is another part of that object and no object of its own; but people have
  // no parts farther off than an arm, and others pass them.
  constexpr double kArm_m = 1.0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (const TrackedObject& track : tracks_) {
      if (cluster_used_[c] || !track.confirmed) continue;
      const double margin_m = track.extent.is_small ? std::min(kArm_m, config_.part_margin_m) : config_.part_margin_m;
      cluster_used_[c] = track.extent.contains(track.state.mean.head<2>(), clusters[c].position_m, margin_m) &&
                         !drives_beside(clusters[c], track);
    }
  }
}

bool Tracker::follow(TrackedObject& track, const Cluster& cluster, const Eigen::Vector2d& sensor) const {
  PositionRate measurement = measurement_of(cluster, track, sensor, config_);
  // What may be a ghost moves the track by as little as it is likely real.
  measurement.covariance /= cluster.realness;
  // What is new knows no velocity to tell wheels by; people are nothing but limbs.
  const bool has_wheels = track.confirmed && !track.extent.is_small;
  if (has_wheels && is_seen_all_round(cluster)) {
    constexpr double kNothing = 1e8;  // m²/s²: the mean of many directions says less than each of them
    measurement.covariance(2, 2) = kNothing;
    if (!update(track.state, measurement)) return false;
    follow_rates(track.state, cluster, sensor);
    return true;
  }
  if (has_wheels) measurement.covariance(2, 2) /= chance_of_body(track.state, measurement);
  return update(track.state, measurement);
}

void Tracker::update_extent(TrackedObject& track, const Cluster& cluster, const Eigen::Vector2d& sensor,
                            bool has_elevation) const {
  const Eigen::Vector2d velocity = track.state.mean.segment<2>(2);
  // People turn as they like: theirs is but the course. Some are in vehicles' boxes, as ghosts made them look strong.
  if (track.extent.is_small || track.extent.is_surely_small(velocity.norm())) {
    constexpr double kLeastCourse_mps = 1.0;
    track.state.heading = {};
    if (velocity.norm() > kLeastCourse_mps) track.extent.follow_heading(std::atan2(velocity.y(), velocity.x()));
  } else {
    follow_heading(track, cluster, sensor, road_);
  }
  if (track.confirmed) {
    constexpr double kSure = 2.0;  // standard deviations
    const Eigen::Vector2d axis(std::cos(track.extent.heading_rad), std::sin(track.extent.heading_rad));
    const Eigen::Matrix2d covariance = track.state.covariance.topLeftCorner<2, 2>() + cluster.covariance_m2;
    const double sure_m = kSure * std::sqrt(axis.dot(covariance * axis));
    track.state.mean.head<2>() += track.extent.grow_to(cluster, track.state.mean.head<2>(), sensor, sure_m);
  }
  track.state.mean.head<2>() +=
      track.extent.update(cluster, track.state.mean.head<2>(), velocity, sensor, has_elevation);
}

void Tracker::push_off(double ego_speed_mps) {
  if (radars_low_m_.x() >= radars_high_m_.x() || radars_low_m_.y() >= radars_high_m_.y()) return;
  const Eigen::Vector2d middle = 0.5 * (radars_low_m_ + radars_high_m_);
  const Eigen::Vector2d half = 0.5 * (radars_high_m_ - radars_low_m_);
  for (TrackedObject& track : tracks_) {
    Vector6d& mean = track.state.mean;
    const Eigen::Vector2d away = track.extent.way_off(mean.head<2>(), middle, half);
    const double depth = away.norm();
    if (depth < 1e-3) continue;
    const Eigen::Vector2d normal = away / depth;
    mean.head<2>() += away;
    // Nor does it come any nearer.
    const Eigen::Vector2d relative = mean.segment<2>(2) - Eigen::Vector2d(ego_speed_mps, 0.0);
    mean.segment<2>(2) -= std::min(0.0, normal.dot(relative)) * normal;
    mean.tail<2>() -= std::min(0.0, normal.dot(mean.tail<2>())) * normal;
  }
}

void Tracker::start_track(const Cluster& cluster, const Eigen::Vector2d& sensor, bool has_elevation) {
  if (tracks_.size() == tracks_.capacity()) {
    ++dropped_tracks_;
    return;
  }
  TrackedObject track = new_track(cluster, sensor, has_elevation, road_, config_);
  track.id = next_id_++;
  tracks_.push_back(track);
}

void Tracker::judge(const ClassifiedScan& scan) {
  const RadarConfig* const radar = vehicle_.radar(scan.header.source_id);
  const Eigen::Vector2d sensor(scan.geometry.sensor_position_vehicle_m[0], scan.geometry.sensor_position_vehicle_m[1]);
  for (TrackedObject& track : tracks_) {
    const bool could_see = track.detections > 0 || (radar != nullptr && can_see(*radar, scan.geometry, track, tracks_,
                                                                                config_.blind_range_rate_mps));
    if (!could_see) continue;
    double wait_s = 0.0;
    if (!track.confirmed || track.age_s < config_.confirm_image_age_s) {
      const double image_s = image_wait_s(track, tracks_, sensor, config_);
      // What would show it may have been found a little later than the image.
      if (image_s > track.age_s && image_s >= config_.confirm_side_image_age_s) track.confirmed = false;
      if (!track.confirmed) wait_s = std::max(image_s, piece_wait_s(track));
    }
    count_scan(track, config_, wait_s);
  }
  std::erase_if(tracks_, [this](const TrackedObject& track) { return is_dead(track, config_); });
}

void Tracker::write(TrackList& out) const {
  out.number_of_tracks = 0;
  out.number_of_confirmed_tracks = 0;
  out.flags = flags_;
  out.dropped_tracks = dropped_tracks_;
  out.tracker_flags = dropped_tracks_ > 0 ? tracker_flag::kCapacityReached : 0;
  out.likelihood_evaluations = 0;
  for (const bool confirmed : {true, false}) {
    for (const TrackedObject& track : tracks_) {
      if (track.confirmed != confirmed) continue;
      write_track(track, config_.stopped_speed_mps, out.tracks[out.number_of_tracks++]);
      out.number_of_confirmed_tracks += confirmed ? 1 : 0;
    }
  }
}

}  // namespace boresight::tracking
