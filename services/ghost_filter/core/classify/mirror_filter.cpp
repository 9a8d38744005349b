#include "services/ghost_filter/core/classify/mirror_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/geometry/ego_step.hpp"
#include "services/ghost_filter/core/classify/place_mirrors.hpp"
#include "services/ghost_filter/core/classify/segments.hpp"
#include "services/ghost_filter/core/density/normal.hpp"
#include "services/ghost_filter/core/pass_on.hpp"

namespace boresight::ghosts {

namespace {

constexpr std::size_t kJudgedAtOnce = 16;  // tracks in a scan
constexpr double kTrackDensity =
    5e-4;                            // of ghosts, for each m² and m/s, at which a track is as likely real as an image
constexpr double kTrackTells = 0.3;  // share of a track in a verdict from which on it stands for the detection
constexpr double kSurest = 3.0;      // log-odds
constexpr double kTrackNegligible = 0.01;  // ratio of densities; less than exp(-kSurest) anyway
constexpr double kNoImage = 0.95;          // weight of an object that surely is where it seems to be
constexpr double kRather = 0.5;            // weight from which on an object is rather there than an image
constexpr double kMoves = 0.8;             // probability from which on what an object shows is no part of the map
constexpr double kAroundBody_m = 0.5;      // what seems to be so near to a body is of it
constexpr double kHeard_db = 3.0;          // a track's strength is known if its std is less
/// Mean strength of tracks of objects from a pedestrian to a truck, beside the usual.
constexpr Strength kObjectStrength{-2.0, 9.0};
constexpr double kObjectDoubt = 0.1;
/// Share of a new judgement of a track in what is thought of it: what has been tracked for long does not become an
/// image, or cease to be one, by a second in which it is where something else would be mirrored.
constexpr double kSlowest = 0.04;

/// In a jam all have about the same speed: to fit one's range rate by chance is easier.
double track_density(double speed_mps) {
  constexpr double kOrdinary_mps = 10.0, kSlow_mps = 2.0;
  return kTrackDensity * std::max(1.0, kOrdinary_mps / std::max(kSlow_mps, speed_mps));
}

/// Weight, in the scans to come, of what is real with that probability. Images are detected again as objects are, but
/// only objects are remembered: weighed by its probability alone, what is rather an image would be told an object after
/// a few scans. So its odds are squared, as if the same evidence had been found a second time.
double remembered(double real) {
  const double unreal = 1.0 - real;
  return real * real / (real * real + unreal * unreal);
}

bool is_usable(const CorrectedScan& scan, std::size_t i) {
  return (scan.detection_flags[i] & corrected_flag::kRejected) == 0 && std::isfinite(scan.x_vehicle_m[i]) &&
         std::isfinite(scan.y_vehicle_m[i]) && std::isfinite(scan.range_rate_over_ground_mps[i]);
}

double positive_or(float value, double fallback) {
  return std::isfinite(value) && value > 0.0F ? static_cast<double>(value) : fallback;
}

/// std::hypot costs ten times as much, for ranges of numbers that floats do not have.
double root_of_squares(double a, double b) {
  return std::sqrt(a * a + b * b);
}

/// Of the range rate of what stands, for a line of sight straight up: by turns of the radar about the axes in the
/// plane.
double tilt_variance(const std::array<float, 6>& mounting, const Eigen::Vector2d& velocity_mps) {
  const double x = -velocity_mps.y(), y = velocity_mps.x();
  const double xx = mounting[0], xy = mounting[1], yy = mounting[3];
  const double variance = x * x * xx + 2.0 * x * y * xy + y * y * yy;
  return std::isfinite(variance) ? std::max(0.0, variance) : 0.0;
}

Eigen::Matrix2d block(const Track& track, std::size_t at) {
  const auto c = [&](std::size_t row, std::size_t column) {
    return static_cast<double>(track.covariance[(at + row) * kTrackStateSize + at + column]);
  };
  Eigen::Matrix2d m;
  m << c(0, 0), c(0, 1), c(1, 0), c(1, 1);
  return m.allFinite() ? m : Eigen::Matrix2d::Identity();
}

}  // namespace

MirrorFilter::MirrorFilter(const MirrorConfig& config)
    : config_(config), map_(config.map), judge_(config.classes), tracks_(std::make_unique<TrackList>()) {
  mirrors_.reserve(kMaxReflectorSegments + kMaxVehicleSides);
  objects_.reserve(Judge::kMaxObjects);
  measured_.resize(kMaxDetections);
  verdicts_.reserve(kMaxDetections);
}

void MirrorFilter::add_tracks(const TrackList& tracks) {
  tracks_->header = tracks.header;
  tracks_->number_of_tracks = std::min<std::uint32_t>(tracks.number_of_tracks, kMaxTracks);
  std::copy_n(tracks.tracks.begin(), tracks_->number_of_tracks, tracks_->tracks.begin());
  has_tracks_ = true;
  images_before_ = images_;
  for (std::size_t i = 0; i < kMaxTracks; ++i) {
    const std::uint32_t id = i < tracks_->number_of_tracks ? tracks_->tracks[i].tracking_id : 0;
    const auto before = std::find_if(images_before_.begin(), images_before_.end(),
                                     [id](const Image& image) { return image.tracking_id == id; });
    images_[i] = id != 0 && before != images_before_.end() ? *before : Image{.tracking_id = id, .log_odds = -1.0};
  }
}

void MirrorFilter::predict_objects(const CorrectedScan& scan) {
  objects_.clear();
  const ClassConfig& c = config_.classes;
  const double elapsed_s =
      static_cast<double>(scan.header.measurement_time_ns - tracks_->header.measurement_time_ns) * 1e-9;
  if (has_tracks_ && std::abs(elapsed_s) <= config_.tracks_max_age_s) {
    const geometry::EgoStep step =
        geometry::ego_step(scan.geometry.ego_speed_mps, scan.geometry.ego_yaw_rate_radps, elapsed_s);
    for (std::uint32_t i = 0; i < tracks_->number_of_tracks; ++i) {
      const Track& track = tracks_->tracks[i];
      const Eigen::Vector2d position(track.position_vehicle_m[0], track.position_vehicle_m[1]);
      const Eigen::Vector2d velocity(track.velocity_over_ground_mps[0], track.velocity_over_ground_mps[1]);
      if (track.tracking_id == 0 || !position.allFinite() || !velocity.allFinite() ||
          !std::isfinite(track.heading_rad)) {
        continue;
      }
      Object o;
      o.position_m = step.move_point(position + elapsed_s * velocity);
      o.axis = step.rotate(
          {std::cos(static_cast<double>(track.heading_rad)), std::sin(static_cast<double>(track.heading_rad))});
      o.half_length_m = 0.5 * positive_or(track.length_m, 4.0);
      o.half_width_m = 0.5 * positive_or(track.width_m, 1.8);
      o.velocity_mps = step.rotate(velocity);
      const Eigen::Matrix2d of_velocity = block(track, 2) + 4.0 * elapsed_s * elapsed_s * Eigen::Matrix2d::Identity();
      o.position_covariance =
          step.to_new * (block(track, 0) + elapsed_s * elapsed_s * of_velocity) * step.to_new.transpose();
      o.velocity_covariance = step.to_new * of_velocity * step.to_new.transpose();
      const double existence = std::isfinite(track.existence_probability)
                                   ? std::clamp(static_cast<double>(track.existence_probability), 0.5, 1.0)
                                   : 0.5;
      const double existing = track.status == TrackStatus::kConfirmed ? existence : existence * c.tentative_weight;
      o.weight = existing / (1.0 + std::exp(2.0 * images_[i].log_odds));
      o.image = existing - o.weight;
      o.rcs_dbsm = images_[i].rcs_dbsm;
      o.rcs_std_db = images_[i].rcs_std_db;
      o.moving = moving_of(o);
      o.mirrors = images_[i].mirrors;
      o.age_s = track.age_s;
      track_of_object_[objects_.size()] = i;
      objects_.push_back(o);
    }
  }
  Object own;
  own.own = true;
  own.weight = 1.0;
  own.position_m = {0.5 * (c.ego_front_m + c.ego_rear_m), 0.0};
  own.half_length_m = 0.5 * (c.ego_front_m - c.ego_rear_m);
  own.half_width_m = c.ego_half_width_m;
  own.velocity_mps = {scan.geometry.ego_speed_mps, scan.geometry.ego_yaw_rate_radps * own.position_m.x()};
  own.velocity_covariance = 0.04 * Eigen::Matrix2d::Identity();
  objects_.push_back(own);
  sources_.clear();
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    Object& o = objects_[i];
    const Eigen::Vector2d extent = most_extent(o).array() + reach_of(o.position_covariance.diagonal());
    o.reach_m = extent.norm();
    o.sectors = sectors_about(o.position_m - sensor_m_, o.reach_m);
    sources_.enter_object(i, o.position_m, extent);
  }
}

double MirrorFilter::still_variance_by_height(const CorrectedScan& scan, std::size_t i, const Measured& m) const {
  const double height_m = scan.z_vehicle_m[i];
  if ((scan.flags & pipeline_flag::kNoElevation) != 0 || !std::isfinite(height_m)) return 0.0;
  // A part of the wave comes by way of the road, unresolved, from as far below it as the thing is above: that draws the
  // elevation to and fro by that share of the angle between both, which no sensor states.
  constexpr double kByRoad = 0.1;
  const double by_road_rad = kByRoad * 2.0 * std::max(0.0, height_m) / m.range_m;
  const double stated_rad = positive_or(scan.elevation_std_rad[i], 0.0);
  // The higher above the sensor, the more an elevation that is wrong takes out too much or too little own motion.
  const double rise = (height_m - sensor_height_m_) / m.range_m;
  const double along = m.direction.dot(sensor_velocity_mps_);
  return rise * rise * (along * along * (stated_rad * stated_rad + by_road_rad * by_road_rad) + tilt_variance_m2ps2_);
}

Measured MirrorFilter::measured(const CorrectedScan& scan, std::size_t i) const {
  Measured m;
  m.position_m = {scan.x_vehicle_m[i], scan.y_vehicle_m[i]};
  const Eigen::Vector2d sight = m.position_m - sensor_m_;
  m.range_m = std::max(0.1, sight.norm());
  m.direction = sight / m.range_m;
  m.rate_mps = scan.range_rate_over_ground_mps[i];
  m.range_std_m = positive_or(scan.range_std_m[i], 0.15);
  m.azimuth_std_rad = root_of_squares(positive_or(scan.azimuth_std_rad[i], 0.005), mounting_std_rad_);
  const double across = m.direction.x() * sensor_velocity_mps_.y() - m.direction.y() * sensor_velocity_mps_.x();
  // A crooked radar takes the own motion out wrongly.
  m.rate_std_mps = root_of_squares(positive_or(scan.range_rate_std_mps[i], 0.05), across * mounting_std_rad_);
  m.still_std_mps =
      std::sqrt(m.rate_std_mps * m.rate_std_mps + 0.06 * 0.06 + ego_speed_std_mps_ * ego_speed_std_mps_ +
                across * across * m.azimuth_std_rad * m.azimuth_std_rad + still_variance_by_height(scan, i, m));
  m.rcs_dbsm = (scan.fields & scan_field::kRcs) != 0 ? static_cast<double>(scan.rcs_dbsm[i])
                                                     : std::numeric_limits<double>::quiet_NaN();
  return m;
}

bool MirrorFilter::is_on_moving(const Eigen::Vector2d& place_m) const {
  bool found = false;
  SourceMap::visit_objects(
      sources_.about(place_m, 0.0), static_cast<std::uint32_t>(objects_.size()), [&](std::uint32_t i) {
        const Object& o = objects_[i];
        found = found || (o.weight > kRather && o.moving >= kMoves && is_on(o, place_m, kAroundBody_m));
      });
  return found;
}

void MirrorFilter::update_map(const CorrectedScan& scan, std::size_t count) {
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_usable(scan, i)) measured_[i].cell = map_.grid().fetch_at(odometry_.point_to_frame(measured_[i].position_m));
  }
  // The scan itself counts: without it the first ghosts would come before any reflector.
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_usable(scan, i) || (scan.detection_flags[i] & corrected_flag::kStationary) == 0) continue;
    Measured& m = measured_[i];
    // What a moving object shows without a range rate is no part of the map.
    if (is_on_moving(m.position_m)) continue;
    const double across = m.range_m * m.azimuth_std_rad;
    m.cell = map_.add(odometry_.point_to_frame(m.position_m), m.range_std_m * m.range_std_m + across * across, time_ns,
                      m.cell);
  }
  for (const Object& o : objects_) {
    if (o.weight < kNoImage || o.moving < 1.0) continue;
    const Eigen::Vector2d reach = o.half_length_m * o.axis;
    map_.drive_over(odometry_.point_to_frame(o.position_m - reach), odometry_.point_to_frame(o.position_m + reach));
  }
  map_.update(odometry_, positive_or(scan.geometry.ego_speed_std_mps, 0.05),
              positive_or(scan.geometry.ego_yaw_rate_std_radps, 0.002));
}

void MirrorFilter::gather_movers(const CorrectedScan& scan, std::size_t count) {
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  echoes_.clear();
  movers_.forget(time_ns - static_cast<std::int64_t>(config_.classes.memory_s * 1e9), odometry_);
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_usable(scan, i) || (scan.detection_flags[i] & corrected_flag::kMoving) == 0) continue;
    const Measured& m = measured_[i];
    // What lies behind a mirror may be an image itself, and an image of an image is too weak to be seen.
    double weight = 1.0 - 0.95 * judge_.behind_mirror(m, static_cast<std::uint32_t>(i));
    // Wheels are too weak to be seen in mirrors.
    const Judge::Owner owner = judge_.owner_of(m);
    if (owner.is_wheel) weight *= 0.05;
    weight *= owner.real * judge_.moves(m);
    const double across = m.range_m * m.azimuth_std_rad;
    echoes_.add({m.direction, m.range_m, m.range_std_m * m.range_std_m, m.azimuth_std_rad * m.azimuth_std_rad,
                 m.rate_mps, m.rcs_dbsm, weight, static_cast<std::uint32_t>(i), owner.object});
    movers_.add({odometry_.point_to_frame(m.position_m), odometry_.vector_to_frame(m.direction), m.rate_mps,
                 m.range_std_m * m.range_std_m + across * across, weight, time_ns, static_cast<std::uint32_t>(i),
                 m.rcs_dbsm, owner.object},
                odometry_);
  }
  movers_.visit_weighing(
      [&](const MovedMover& mover) { sources_.enter_mover(mover.position_m, judge_.reach_of_mover(mover)); });
}

void MirrorFilter::judge_tracks() {
  // In turns where there are many, so that a crowd does not cost its square.
  const std::size_t tracks = objects_.size() - 1;
  const std::size_t first = tracks > kJudgedAtOnce ? turn_ % tracks : 0;
  const std::size_t judged = std::min(tracks, kJudgedAtOnce);
  turn_ = first + judged;
  for (std::size_t i = 0; i < judged; ++i) {
    const auto k = static_cast<std::uint32_t>((first + i) % tracks);
    const Object& o = objects_[k];
    Measured m;
    m.position_m = o.position_m;
    const Eigen::Vector2d sight = o.position_m - sensor_m_;
    m.range_m = sight.norm();
    if (m.range_m < 1.0) continue;
    m.direction = sight / m.range_m;
    m.rate_mps = m.direction.dot(o.velocity_mps);
    const Eigen::Vector2d across(-m.direction.y(), m.direction.x());
    m.range_std_m = 0.5 + std::sqrt(std::max(0.0, m.direction.dot(o.position_covariance * m.direction)));
    m.azimuth_std_rad = (0.4 + std::sqrt(std::max(0.0, across.dot(o.position_covariance * across)))) / m.range_m;
    m.rate_std_mps = 0.3 + std::sqrt(std::max(0.0, m.direction.dot(o.velocity_covariance * m.direction)));
    m.still_std_mps = m.rate_std_mps;
    Image& image = images_[track_of_object_[k]];
    // An image is weaker than what is mirrored.
    const bool heard = image.rcs_std_db < kHeard_db;
    m.rcs_dbsm = heard ? image.rcs_dbsm : std::numeric_limits<double>::quiet_NaN();
    const double strength =
        heard ? likelihood(kObjectStrength, image.rcs_dbsm - kUsualRcs_dbsm, image.rcs_std_db, kObjectDoubt) : 1.0;
    const double real = strength * track_density(o.velocity_mps.norm());
    const double image_density = judge_.images(m, k, kTrackNegligible * real);
    const double score = std::clamp(std::log((image_density + 1e-12) / real), -kSurest, kSurest);
    ++image.judgements;
    image.log_odds += std::max(kSlowest, 1.0 / (1.0 + image.judgements)) * (score - image.log_odds);
  }
}

void MirrorFilter::try_mirrors(const CorrectedScan& scan, std::size_t count) {
  constexpr std::size_t kAtOnce = 8;  // from scan to scan an image hardly changes, so that turns lose little
  trials_.begin();
  for (std::size_t i = 0; i < count; ++i) {
    if (is_usable(scan, i)) trials_.saw(measured_[i].direction, measured_[i].range_m);
  }
  const MirrorTrials::Scan seen{sensor_m_, sensor_velocity_mps_, mounting_std_rad_, objects_, &odometry_, &movers_};
  const std::size_t reflectors = map_.reflectors().size();
  for (std::size_t k = 0; k < std::min(kAtOnce, reflectors); ++k) {
    const std::size_t i = mirrors_turn_++ % reflectors;
    map_.tried(i, trials_.evidence_of(mirrors_[i], seen));
  }
  // Of vehicles it is only learnt that they mirror. Most that are as long do, and where no image is seen in one it is
  // rather hidden, or too weak: that hardly tells them from cars.
  constexpr double kMost = 4.0;
  const std::size_t faces = mirrors_.size() - reflectors;
  for (std::size_t k = 0; k < std::min(kAtOnce, faces); ++k) {
    const Mirror& face = mirrors_[reflectors + faces_turn_++ % faces];
    double& learnt = images_[track_of_object_[face.body]].mirrors;
    learnt = std::clamp(learnt + trials_.evidence_of(face, seen), 0.0, kMost);
  }
}

void MirrorFilter::learn_strength(const Densities& densities, const Measured& m) {
  // Written so that nothing, and what is not a number, teaches nothing: there is no object then.
  if (!std::isfinite(m.rcs_dbsm) || !(densities.of_body > 0.5 * densities.sum())) return;
  Image& image = images_[track_of_object_[densities.object]];
  // As a Kalman filter of a constant would, but it never ceases to learn: the aspect changes.
  constexpr double kLeastStd_db = 1.0;
  const double variance = image.rcs_std_db * image.rcs_std_db;
  const double gain = variance / (variance + kBodyStrength.std_db * kBodyStrength.std_db);
  image.rcs_dbsm += gain * (m.rcs_dbsm - image.rcs_dbsm);
  image.rcs_std_db = std::max(kLeastStd_db, std::sqrt((1.0 - gain) * variance));
}

void MirrorFilter::write_verdict(const Densities& densities, std::size_t i, ClassifiedScan& out) const {
  const double sum = densities.sum();
  if (!(sum > 0.0)) {
    out.provenance[i] = Provenance::kClutter;
    out.ghost_probability[i] = 0.5F;
    return;
  }
  const double unreal = densities.type1 + densities.type2 + densities.clutter;
  out.ghost_probability[i] = static_cast<float>(unreal / sum);
  if (unreal < config_.classes.decision_probability * sum) {
    out.provenance[i] = densities.moving >= densities.stationary ? Provenance::kMoving : Provenance::kStationary;
  } else if (densities.clutter > densities.type1 + densities.type2) {
    out.provenance[i] = Provenance::kClutter;
  } else {
    out.provenance[i] = densities.type1 > densities.type2 ? Provenance::kGhostType1 : Provenance::kGhostType2;
  }
}

void MirrorFilter::classify(const CorrectedScan& scan, ClassifiedScan& out) {
  const std::size_t count = pass_on(scan, out);
  const ScanGeometry& g = scan.geometry;
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  if (!has_tracks_) {
    out.flags |= pipeline_flag::kNoTracks;
  } else if (std::abs(static_cast<double>(time_ns - tracks_->header.measurement_time_ns)) * 1e-9 >
             config_.tracks_max_age_s) {
    out.flags |= pipeline_flag::kTracksStale;
  }
  sensor_m_ = {g.sensor_position_vehicle_m[0], g.sensor_position_vehicle_m[1]};
  sensor_velocity_mps_ = {g.sensor_velocity_vehicle_mps[0], g.sensor_velocity_vehicle_mps[1]};
  ego_speed_std_mps_ = std::hypot(positive_or(g.ego_speed_std_mps, 0.05),
                                  positive_or(scan.speed_scale_std, 0.0) * static_cast<double>(g.ego_speed_mps));
  sensor_height_m_ = g.sensor_position_vehicle_m[2];
  mounting_std_rad_ = std::sqrt(positive_or(scan.mounting_covariance[5], 0.0));
  tilt_variance_m2ps2_ = tilt_variance(scan.mounting_covariance, sensor_velocity_mps_);
  if (!odometry_.advance(time_ns, g.ego_speed_mps, g.ego_yaw_rate_radps)) {
    map_.clear();
    movers_.clear();
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (is_usable(scan, i)) measured_[i] = measured(scan, i);
  }
  predict_objects(scan);
  update_map(scan, count);
  place_mirrors(map_.reflectors(), odometry_, objects_, sensor_m_, config_.classes, mirrors_);
  judge_.begin(
      {sensor_m_, sensor_velocity_mps_, mirrors_, objects_, &sources_, &odometry_, &movers_, &echoes_, &map_.grid()});
  gather_movers(scan, count);
  judge_tracks();
  try_mirrors(scan, count);

  verdicts_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    out.provenance[i] = Provenance::kUnknown;
    out.ghost_probability[i] = 0.0F;
    if (!is_usable(scan, i)) continue;
    const bool moving = (scan.detection_flags[i] & corrected_flag::kMoving) != 0;
    if (!moving && (scan.detection_flags[i] & corrected_flag::kStationary) == 0) continue;
    const Measured& m = measured_[i];
    const Densities d = moving ? judge_.weigh(m, static_cast<std::uint32_t>(i)) : judge_.weigh_still(m);
    write_verdict(d, i, out);
    learn_strength(d, m);
    if (const std::size_t mover = movers_.earlier() + verdicts_.size();
        moving && mover < movers_.size() && movers_[mover].index == i) {
      // Where there is a track, that tells the next scans more than single detections.
      const bool tracked = d.of_tracks > kTrackTells * d.sum();
      constexpr double kOfNoTrack = 1e-6;
      const double of_real = (d.of_tracks + kOfNoTrack) / (d.of_tracks + d.of_images + kOfNoTrack);
      const double apparent = d.sum() - d.stationary;  // what does not stand, real or not
      const double real = of_real * d.moving / std::max(apparent, 1e-300);
      verdicts_.push_back(tracked ? 0.0 : remembered(real) * apparent / std::max(d.sum(), 1e-300));
    }
  }
  // Only now: what is judged first must not count otherwise than what is judged last.
  for (std::size_t k = 0; k < verdicts_.size(); ++k) movers_.set_weight(movers_.earlier() + k, verdicts_[k]);
  write_segments(map_.reflectors(), odometry_, out);
}

}  // namespace boresight::ghosts
