#include "services/tracker/core/tracker.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "services/common/geometry/ego_step.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/heading.hpp"

namespace boresight::tracking {

namespace {

/// The cluster as a measurement of the centre of the box that it would be the visible part of. How far the mean of what
/// is seen may be from where the box says it is goes with its size.
PositionRate measurement_of(const Cluster& cluster, const Extent& extent, const Eigen::Vector2d& visible_mean_m,
                            double centre_std_m) {
  constexpr double kLeast = 0.25;  // of a person who walks
  const double share = extent.is_small ? std::clamp(extent.length_m / Extent::kCarLength_m, kLeast, 1.0) : 1.0;
  PositionRate m;
  m.value << cluster.position_m - visible_mean_m, cluster.range_rate_over_ground_mps;
  m.covariance.setZero();
  m.covariance.topLeftCorner<2, 2>() =
      cluster.covariance_m2 + share * share * centre_std_m * centre_std_m * Eigen::Matrix2d::Identity();
  m.covariance(2, 2) = cluster.range_rate_variance;
  m.line_of_sight = cluster.mean_sight;
  return m;
}

constexpr double kSlow_mps = 0.7;  // a vehicle that is about to stand

/// Rails and walls stand, too.
bool is_of_reflector(const ClassifiedScan& scan, const Eigen::Vector2d& place_m) {
  constexpr double kNear_m = 0.7;
  const std::size_t count = std::min<std::size_t>(scan.number_of_reflector_segments, kMaxReflectorSegments);
  return std::any_of(scan.reflector_segments.begin(),
                     scan.reflector_segments.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const ReflectorSegment& segment) {
                       const Eigen::Vector2d from(segment.start_vehicle_m[0], segment.start_vehicle_m[1]),
                           to(segment.end_vehicle_m[0], segment.end_vehicle_m[1]);
                       const Eigen::Vector2d along = to - from;
                       const double share = (place_m - from).dot(along) / std::max(1e-6, along.squaredNorm());
                       return (place_m - from - std::clamp(share, 0.0, 1.0) * along).norm() < kNear_m;
                     });
}

std::uint32_t window_mask(std::size_t scans) {
  return scans >= 32 ? ~0u : (1u << scans) - 1u;
}

}  // namespace

Tracker::Tracker(const VehicleConfig& vehicle, const Config& config)
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
  const bool has_elevation = (scan.flags & pipeline_flag::kNoElevation) == 0;
  const std::span<const Cluster> clusters = join_parts(clusterer_.find(scan, people()));
  result.dropped_clusters = clusterer_.dropped();
  const Eigen::Vector2d sensor(scan.geometry.sensor_position_vehicle_m[0], scan.geometry.sensor_position_vehicle_m[1]);
  assign(clusters, sensor, has_elevation);
  push_off(scan.geometry.ego_speed_mps);
  keep_stopped(scan);
  judge(scan);
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (cluster_used_[c] || clusters[c].realness < config_.start_realness) continue;
    start_track(clusters[c], sensor, has_elevation);
  }
  remove_duplicates(sensor);
  result.dropped_tracks = dropped_tracks_;
  return result;
}

void Tracker::predict_all(double elapsed_s, const ScanGeometry& geometry) {
  const geometry::EgoStep ego = geometry::ego_step(geometry.ego_speed_mps, geometry.ego_yaw_rate_radps, elapsed_s);
  const double turn = static_cast<double>(geometry.ego_yaw_rate_radps) * elapsed_s;
  for (Entry& track : tracks_) {
    predict(track.state, elapsed_s, config_.jerk_std_mps3, ego);
    if (track.state.heading.known) predict_heading(track.state, elapsed_s, turn);
    track.extent.heading_rad = geometry::wrap_angle(track.extent.heading_rad - turn);
    track.age_s += elapsed_s;
    track.since_update_s += elapsed_s;
    track.detections = 0;
  }
}

std::span<const Eigen::Vector2d> Tracker::people() {
  std::size_t count = 0;
  for (const Entry& track : tracks_) {
    if (track.confirmed && track.extent.is_small) people_[count++] = track.state.mean.head<2>();
  }
  return {people_.data(), count};
}

std::span<const Cluster> Tracker::join_parts(std::span<const Cluster> clusters) {
  // A long vehicle reflects at its ends and little between: what lies in its box and moves with it is one thing.
  constexpr double kMargin_m = 0.5;
  for (const Entry& track : tracks_) {
    if (!track.confirmed) continue;
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
    visible_mean_[t] = tracks_[t].extent.visible_mean(tracks_[t].state.mean.head<2>(), sensor);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      const Distance d = distance(
          tracks_[t].state, measurement_of(clusters[c], tracks_[t].extent, visible_mean_[t], config_.centre_std_m));
      if (d.squared >= config_.gate_chi2) continue;
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
    Entry& track = tracks_[t];
    // What may be a ghost moves the track by as little as it is likely real.
    PositionRate measurement = measurement_of(cluster, track.extent, visible_mean_[t], config_.centre_std_m);
    measurement.covariance /= cluster.realness;
    if (!update(track.state, measurement)) continue;
    cluster_used_[static_cast<std::size_t>(column)] = true;
    update_extent(track, cluster, sensor, has_elevation);
    track.slow = track.state.mean.segment<2>(2).norm() < kSlow_mps;
    track.since_update_s = 0.0;
    track.detections = cluster.number_of_detections;
    track.realness = cluster.realness;
  }
  // What lies within a confirmed track's box is another part of that object and no object of its own.
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (const Entry& track : tracks_) {
      if (cluster_used_[c] || !track.confirmed) continue;
      cluster_used_[c] =
          track.extent.contains(track.state.mean.head<2>(), clusters[c].position_m, config_.part_margin_m);
    }
  }
}

void Tracker::update_extent(Entry& track, const Cluster& cluster, const Eigen::Vector2d& sensor, bool has_elevation) {
  const Eigen::Vector2d velocity = track.state.mean.segment<2>(2);
  constexpr double kLeastCourse_mps = 1.0;
  // People turn as they like: theirs is but the course. Some are in vehicles' boxes, as ghosts made them look strong.
  if (track.extent.is_small || track.extent.may_be_small(velocity.norm())) {
    track.state.heading = {};
  } else if (track.state.heading.known) {
    hold_to_heading(track.state);
  } else {
    begin_heading(track.state);
    const auto turn = turn_of_flank(cluster, track.extent.heading_rad);
    if (!track.state.heading.known && turn) begin_heading(track.state, track.extent.heading_rad, *turn);
  }
  if (track.state.heading.known) {
    if (const auto turn = turn_of_flank(cluster, track.state.heading.rad)) measure_heading(track.state, *turn);
    track.extent.follow_heading(track.state.heading.rad);
  } else if (velocity.norm() > kLeastCourse_mps) {
    track.extent.follow_heading(std::atan2(velocity.y(), velocity.x()));
  }
  track.extent.update(cluster, track.state.mean.head<2>(), track.state.mean.segment<2>(2), sensor, has_elevation);
}

void Tracker::push_off(double ego_speed_mps) {
  if (radars_low_m_.x() >= radars_high_m_.x() || radars_low_m_.y() >= radars_high_m_.y()) return;
  const Eigen::Vector2d middle = 0.5 * (radars_low_m_ + radars_high_m_);
  const Eigen::Vector2d half = 0.5 * (radars_high_m_ - radars_low_m_);
  for (Entry& track : tracks_) {
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

void Tracker::keep_stopped(const ClassifiedScan& scan) {
  // What has come to a stand is no longer detected as moving, but it is where it was. Ghosts' tracks, too, come to rest
  // on what stands somewhere, but do not live so long before.
  constexpr double kLongEnough_s = 5.0, kSure = 0.9;
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (Entry& track : tracks_) {
    if (!track.confirmed || !track.slow || track.detections > 0 || track.age_s < kLongEnough_s ||
        track.existence < kSure) {
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (scan.provenance[i] != Provenance::kStationary) continue;
      const Eigen::Vector2d place(scan.x_vehicle_m[i], scan.y_vehicle_m[i]);
      if (!track.extent.contains(track.state.mean.head<2>(), place, 0.0) || is_of_reflector(scan, place)) continue;
      come_to_rest(track.state);
      track.since_update_s = 0.0;
      break;
    }
  }
}

void Tracker::start_track(const Cluster& cluster, const Eigen::Vector2d& sensor, bool has_elevation) {
  if (tracks_.size() == tracks_.capacity()) {
    ++dropped_tracks_;
    return;
  }
  Entry track;
  track.id = next_id_++;
  track.state.mean.segment<2>(2) = cluster.range_rate_over_ground_mps * cluster.line_of_sight;
  track.state.covariance.setZero();
  const double centre =
      config_.start_position_std_m * config_.start_position_std_m + config_.centre_std_m * config_.centre_std_m;
  track.state.covariance.topLeftCorner<2, 2>() = cluster.covariance_m2 + centre * Eigen::Matrix2d::Identity();
  // The range rate says the speed along the line of sight; across it nothing is known.
  const Eigen::Vector2d u = cluster.line_of_sight, v(-u.y(), u.x());
  const double across = config_.start_speed_std_mps * config_.start_speed_std_mps;
  track.state.covariance.block<2, 2>(2, 2) =
      cluster.range_rate_variance * u * u.transpose() + across * v * v.transpose();
  const double acceleration = config_.start_acceleration_std_mps2 * config_.start_acceleration_std_mps2;
  track.state.covariance.bottomRightCorner<2, 2>() = acceleration * Eigen::Matrix2d::Identity();
  track.extent.heading_rad = std::atan2(track.state.mean(3), track.state.mean(2));
  if (cluster.number_on_outline > 0) track.extent.hear(cluster.strongest_dbsm, track.state.mean.segment<2>(2).norm());
  track.state.mean.head<2>() = cluster.position_m - track.extent.visible_mean(cluster.position_m, sensor);
  track.extent.update(cluster, track.state.mean.head<2>(), track.state.mean.segment<2>(2), sensor, has_elevation);
  track.history = 1;
  track.evidence[0] = static_cast<float>(cluster.realness);
  track.seen_scans = 1;
  track.detections = cluster.number_of_detections;
  tracks_.push_back(track);
}

bool Tracker::can_see(const ScanGeometry& geometry, std::uint32_t radar_id, const Entry& track) const {
  const RadarConfig* const radar = vehicle_.radar(radar_id);
  if (radar == nullptr) return false;
  const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> rotation(geometry.sensor_to_vehicle.data());
  const Eigen::Vector3d sight(track.state.mean(0) - static_cast<double>(geometry.sensor_position_vehicle_m[0]),
                              track.state.mean(1) - static_cast<double>(geometry.sensor_position_vehicle_m[1]), 0.0);
  // Who moves across the line of sight has no range rate over ground and looks stationary.
  const double range_rate = sight.head<2>().normalized().dot(track.state.mean.segment<2>(2));
  if (std::abs(range_rate) < config_.blind_range_rate_mps) return false;
  const Eigen::Vector3d in_sensor = rotation.cast<double>().transpose() * sight;
  const double azimuth = std::atan2(in_sensor.y(), in_sensor.x());
  const FieldOfView& view = radar->field_of_view;
  if (azimuth <= view.azimuth_min_rad || azimuth >= view.azimuth_max_rad || sight.norm() >= view.range_max_m) {
    return false;
  }
  // Behind a vehicle that is surely there it is hidden, to this radar.
  constexpr double kSurelyThere = 0.95;
  const Eigen::Vector2d to = track.state.mean.head<2>(), from = to - sight.head<2>();
  return std::none_of(tracks_.begin(), tracks_.end(), [&](const Entry& other) {
    return &other != &track && other.confirmed && other.existence > kSurelyThere && !other.extent.is_small &&
           other.extent.hides(other.state.mean.head<2>(), from, to);
  });
}

bool Tracker::is_dead(const Entry& track) const {
  if (track.since_update_s > config_.coast_s || !track.state.mean.allFinite() || !track.state.covariance.allFinite() ||
      !std::isfinite(track.state.heading.rad)) {
    return true;
  }
  const std::uint32_t seen = window_mask(track.seen_scans);
  const std::uint32_t misses = ~track.history & seen & window_mask(config_.delete_window);
  if (std::popcount(misses) >= static_cast<int>(config_.delete_misses)) return true;
  // A tentative track that can no longer be confirmed in its window gives up its place.
  const std::uint32_t window = seen & window_mask(config_.confirm_window);
  const std::size_t early_misses = static_cast<std::size_t>(std::popcount(~track.history & window));
  return !track.confirmed && early_misses > config_.confirm_window - config_.confirm_hits;
}

void Tracker::judge(const ClassifiedScan& scan) {
  constexpr double kDetection = 0.8, kHitGain = 0.5;
  for (Entry& track : tracks_) {
    const bool hit = track.detections > 0;
    if (!hit && !can_see(scan.geometry, scan.header.source_id, track)) continue;
    track.history = track.history << 1 | (hit ? 1u : 0u);
    std::shift_right(track.evidence.begin(), track.evidence.end(), 1);
    track.evidence[0] = hit ? static_cast<float>(track.realness) : 0.0F;
    track.seen_scans = std::min<std::uint32_t>(track.seen_scans + 1, 32);
    track.existence = hit ? track.existence + kHitGain * track.realness * (0.999 - track.existence)
                          : track.existence * (1.0 - kDetection) / (1.0 - kDetection * track.existence);
    const std::uint32_t recent = track.history & window_mask(config_.confirm_window);
    const auto window = track.evidence.begin() + static_cast<std::ptrdiff_t>(config_.confirm_window);
    const double evidence = std::accumulate(track.evidence.begin(), window, 0.0);
    const bool often = std::popcount(recent) >= static_cast<int>(config_.confirm_hits);
    const bool long_enough = track.age_s > config_.confirm_age_s - 1e-6;
    if (often && long_enough && evidence >= config_.confirm_evidence) track.confirmed = true;
  }
  std::erase_if(tracks_, [this](const Entry& track) { return is_dead(track); });
}

bool Tracker::are_one(const Entry& a, const Entry& b, const Eigen::Vector2d& sensor) const {
  const Eigen::Vector2d p = a.state.mean.head<2>(), q = b.state.mean.head<2>();
  const Eigen::Vector2d velocity = a.state.mean.segment<2>(2);
  const double apart_mps = (velocity - b.state.mean.segment<2>(2)).norm();
  // Two vehicles that have both long been tracked, each at a speed of its own, are two, wherever ghosts draw them. The
  // limbs of who walks have their own speeds, too, but no vehicle's length.
  constexpr double kLong_s = 2.0, kOwnSpeed_mps = 2.5, kVehicle_m = 2.5;
  if (a.confirmed && b.confirmed && std::min(a.age_s, b.age_s) > kLong_s && apart_mps > kOwnSpeed_mps &&
      std::min(a.extent.length_m, b.extent.length_m) > kVehicle_m) {
    return false;
  }
  // What has its middle in another one's box is no object of its own at whatever velocity: a wheel, or a limb.
  if (a.extent.contains(p, q, 0.0) || b.extent.contains(q, p, 0.0)) return true;
  if (apart_mps > config_.duplicate_speed_mps) return false;
  const double margin_m = config_.duplicate_margin_m;
  if (a.extent.contains(p, q, margin_m) || b.extent.contains(q, p, margin_m)) return true;
  if (!a.extent.shows_side(p, sensor)) return false;
  // Both ends of a long vehicle: nobody follows so closely.
  constexpr double kSmallestHeadway_s = 0.3;
  return a.extent.in_file(p, b.extent, q, kSmallestHeadway_s * velocity.norm());
}

void Tracker::remove_duplicates(const Eigen::Vector2d& sensor) {
  // The older one, or the confirmed one, stays.
  for (std::size_t a = 0; a < tracks_.size(); ++a) {
    for (std::size_t b = a + 1; b < tracks_.size();) {
      if (!are_one(tracks_[a], tracks_[b], sensor)) {
        ++b;
        continue;
      }
      if (tracks_[b].confirmed && !tracks_[a].confirmed) std::swap(tracks_[a], tracks_[b]);
      Entry& kept = tracks_[a];
      const Entry& gone = tracks_[b];
      const double speed_mps = (kept.state.mean - gone.state.mean).segment<2>(2).norm();
      const bool shows_side = kept.extent.shows_side(kept.state.mean.head<2>(), sensor);
      if (gone.confirmed && shows_side && speed_mps <= config_.duplicate_speed_mps) {
        kept.state.mean.head<2>() = kept.extent.lengthen(kept.state.mean.head<2>(), gone.state.mean.head<2>());
      }
      tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(b));
    }
  }
}

void Tracker::write(TrackList& out) const {
  out.number_of_tracks = 0;
  out.number_of_confirmed_tracks = 0;
  out.flags = flags_;
  out.dropped_tracks = dropped_tracks_;
  out.reserved = 0;
  for (const bool confirmed : {true, false}) {
    for (const Entry& track : tracks_) {
      if (track.confirmed != confirmed) continue;
      Track& t = out.tracks[out.number_of_tracks++];
      out.number_of_confirmed_tracks += confirmed ? 1 : 0;
      const Vector6d& m = track.state.mean;
      t.tracking_id = track.id;
      t.status = confirmed ? TrackStatus::kConfirmed : TrackStatus::kTentative;
      t.update = track.detections > 0 ? TrackUpdate::kMeasured : TrackUpdate::kPredicted;
      const double speed = m.segment<2>(2).norm();
      t.movement = speed < config_.stopped_speed_mps ? MovementState::kStopped : MovementState::kMoving;
      t.object_class = track.extent.object_class();
      t.age_s = static_cast<float>(track.age_s);
      t.time_since_update_s = static_cast<float>(track.since_update_s);
      t.existence_probability = static_cast<float>(track.existence);
      t.heading_rad = static_cast<float>(track.extent.heading_rad);
      t.length_m = static_cast<float>(track.extent.length_m);
      t.width_m = static_cast<float>(track.extent.width_m);
      t.height_m = static_cast<float>(track.extent.height_m);
      t.position_vehicle_m = {static_cast<float>(m(0)), static_cast<float>(m(1)),
                              static_cast<float>(0.5 * track.extent.height_m)};
      t.velocity_over_ground_mps = {static_cast<float>(m(2)), static_cast<float>(m(3))};
      t.acceleration_over_ground_mps2 = {static_cast<float>(m(4)), static_cast<float>(m(5))};
      t.number_of_detections = track.detections;
      t.reserved = {};
      Eigen::Map<Eigen::Matrix<float, 6, 6, Eigen::RowMajor>>(t.covariance.data()) =
          track.state.covariance.cast<float>();
    }
  }
}

}  // namespace boresight::tracking
