#include "services/ghost_filter/core/classify/mirror_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/geometry/ego_step.hpp"
#include "services/ghost_filter/core/classify/place_mirrors.hpp"
#include "services/ghost_filter/core/classify/predicted_object.hpp"
#include "services/ghost_filter/core/classify/segments.hpp"
#include "services/ghost_filter/core/density/normal.hpp"
#include "services/ghost_filter/core/pass_on.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kTrackDensity =
    5e-4;                            // of ghosts, for each m² and m/s, at which a track is as likely real as an image
constexpr double kTrackTells = 0.3;  // share of a track in a verdict from which on it stands for the detection
constexpr double kSurest = 3.0;      // log-odds
constexpr double kTrackNegligible = 0.01;  // ratio of densities; less than exp(-kSurest) anyway
constexpr double kNoImage = 0.95;          // weight of an object that surely is where it seems to be
/// A new track may seem to drive across the road, through rails; what is driven through stays open for good.
constexpr double kKnowsCourse_s = 2.0;
constexpr double kRather = 0.5;        // weight from which on an object is rather there than an image
constexpr double kMoves = 0.8;         // probability from which on what an object shows is no part of the map
constexpr double kAroundBody_m = 0.5;  // what seems to be so near to a body is of it
constexpr double kHeard_db = 3.0;      // a track's strength is known if its std is less
/// Mean strength of tracks of objects from a pedestrian to a truck, beside the usual.
constexpr Strength kObjectStrength{-2.0, 9.0};
constexpr double kObjectDoubt = 0.1;
/// Share of a new judgement of a track in what is thought of it: what has been tracked for long does not become an
/// image, or cease to be one, by a second in which it is where something else would be mirrored. With four radars of 20
/// scans a second it follows within some seconds.
constexpr double kSlowest = 0.015;

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
  beliefs_before_ = beliefs_;
  for (std::size_t i = 0; i < kMaxTracks; ++i) {
    const std::uint32_t id = i < tracks_->number_of_tracks ? tracks_->tracks[i].tracking_id : 0;
    const auto before = std::find_if(beliefs_before_.begin(), beliefs_before_.end(),
                                     [id](const TrackBelief& belief) { return belief.tracking_id == id; });
    beliefs_[i] =
        id != 0 && before != beliefs_before_.end() ? *before : TrackBelief{.tracking_id = id, .log_odds = -1.0};
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
      const auto o = predicted(tracks_->tracks[i], beliefs_[i], elapsed_s, step, c.tentative_weight);
      if (!o) continue;
      track_of_object_[objects_.size()] = i;
      objects_.push_back(*o);
    }
  }
  objects_.push_back(own_vehicle(c, scan.geometry));
  sources_.clear();
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    Object& o = objects_[i];
    const Eigen::Vector2d extent = most_extent(o).array() + reach_of(o.position_covariance.diagonal());
    o.reach_m = extent.norm();
    o.sectors = sectors_about(o.position_m - from_.sensor_m, o.reach_m);
    sources_.enter_object(i, o.position_m, extent);
  }
}

bool MirrorFilter::is_on_moving(const Eigen::Vector2d& place_m) const {
  bool found = false;
  SourceMap::visit_objects(
      sources_.objects_about(place_m, 0.0), static_cast<std::uint32_t>(objects_.size()), [&](std::uint32_t i) {
        const Object& o = objects_[i];
        found = found || (o.weight > kRather && o.moving >= kMoves && is_on(o, place_m, kAroundBody_m));
      });
  return found;
}

void MirrorFilter::cast_shadows() {
  Shadows& shadows = map_.shadows();
  shadows.begin(odometry_.point_to_frame(objects_.back().position_m));  // the own vehicle
  for (const Object& o : objects_) {
    if (o.own || o.weight < kNoImage) continue;
    shadows.add(odometry_.point_to_frame(o.position_m), odometry_.vector_to_frame(o.axis), o.half_length_m,
                o.half_width_m);
  }
}

void MirrorFilter::update_map(const CorrectedScan& scan, std::size_t count) {
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  // The scan itself counts: without it the first ghosts would come before any reflector.
  for (std::size_t i = 0; i < count; ++i) {
    if (kinds_[i] != Kind::kStationary) continue;
    Measured& m = measured_[i];
    // What a moving object shows without a range rate is no part of the map.
    if (is_on_moving(m.position_m)) continue;
    const double across = m.range_m * m.azimuth_std_rad;
    m.cell = map_.add(odometry_.point_to_frame(m.position_m), m.range_std_m * m.range_std_m + across * across, time_ns,
                      m.cell);
  }
  for (const Object& o : objects_) {
    if (o.weight < kNoImage || o.moving < 1.0 || o.age_s < kKnowsCourse_s) continue;
    const Eigen::Vector2d reach = o.half_length_m * o.axis;
    map_.drive_over(odometry_.point_to_frame(o.position_m - reach), odometry_.point_to_frame(o.position_m + reach));
  }
  cast_shadows();
  map_.update(odometry_, positive_or(scan.geometry.ego_speed_std_mps, 0.05),
              positive_or(scan.geometry.ego_yaw_rate_std_radps, 0.002));
}

void MirrorFilter::gather_movers(const CorrectedScan& scan, std::size_t count) {
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  echoes_.clear();
  const auto before_now = [time_ns](double s) { return time_ns - static_cast<std::int64_t>(s * 1e9); };
  const ClassConfig& c = config_.classes;
  movers_.forget(before_now(std::max(c.sighting_s, c.memory_s)), before_now(c.memory_s), odometry_);
  for (std::size_t i = 0; i < count; ++i) {
    if (kinds_[i] != Kind::kMoving) continue;
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
  const std::size_t judged = tracks_pace_.take(tracks);
  const std::size_t first = tracks > judged ? turn_ % tracks : 0;
  turn_ = first + judged;
  for (std::size_t i = 0; i < judged; ++i) {
    const auto k = static_cast<std::uint32_t>((first + i) % tracks);
    const Object& o = objects_[k];
    Measured m;
    m.position_m = o.position_m;
    const Eigen::Vector2d sight = o.position_m - from_.sensor_m;
    m.range_m = sight.norm();
    if (m.range_m < 1.0) continue;
    m.direction = sight / m.range_m;
    m.rate_mps = m.direction.dot(o.velocity_mps);
    const Eigen::Vector2d across(-m.direction.y(), m.direction.x());
    m.range_std_m = 0.5 + std::sqrt(std::max(0.0, m.direction.dot(o.position_covariance * m.direction)));
    m.azimuth_std_rad = (0.4 + std::sqrt(std::max(0.0, across.dot(o.position_covariance * across)))) / m.range_m;
    m.rate_std_mps = 0.3 + std::sqrt(std::max(0.0, m.direction.dot(o.velocity_covariance * m.direction)));
    m.still_std_mps = m.rate_std_mps;
    TrackBelief& belief = beliefs_[track_of_object_[k]];
    // An image is weaker than what is mirrored.
    const bool heard = belief.rcs_std_db < kHeard_db;
    m.rcs_dbsm = heard ? belief.rcs_dbsm : std::numeric_limits<double>::quiet_NaN();
    const double strength =
        heard ? likelihood(kObjectStrength, belief.rcs_dbsm - kUsualRcs_dbsm, belief.rcs_std_db, kObjectDoubt) : 1.0;
    const double real = strength * track_density(o.velocity_mps.norm());
    const double image_density = judge_.images(m, k, kTrackNegligible * real);
    const double score = std::clamp(std::log((image_density + 1e-12) / real), -kSurest, kSurest);
    ++belief.judgements;
    belief.log_odds += std::max(kSlowest, 1.0 / (1.0 + belief.judgements)) * (score - belief.log_odds);
  }
}

void MirrorFilter::try_mirrors() {
  // From scan to scan an image hardly changes, so that turns lose little.
  const MirrorTrials::Scan seen{from_.sensor_m, from_.sensor_velocity_mps, from_.mounting_std_rad, objects_, &odometry_,
                                &movers_};
  const std::size_t reflectors = map_.reflectors().size();
  for (std::size_t left = mirrors_pace_.take(reflectors); left > 0; --left) {
    const std::size_t i = mirrors_turn_++ % reflectors;
    map_.tried(i, trials_.evidence_of(mirrors_[i], seen));
  }
  // Of vehicles it is only learnt that they mirror. Most that are as long do, and where no image is seen in one it is
  // rather hidden, or too weak: that hardly tells them from cars.
  constexpr double kMost = 4.0;
  const std::size_t faces = mirrors_.size() - reflectors;
  for (std::size_t left = faces_pace_.take(faces); left > 0; --left) {
    const Mirror& face = mirrors_[reflectors + faces_turn_++ % faces];
    double& learnt = beliefs_[track_of_object_[face.body]].mirrors;
    learnt = std::clamp(learnt + trials_.evidence_of(face, seen), 0.0, kMost);
  }
}

void MirrorFilter::learn_strength(const Densities& densities, const Measured& m) {
  // Written so that nothing, and what is not a number, teaches nothing: there is no object then.
  if (!std::isfinite(m.rcs_dbsm) || !(densities.of_body > 0.5 * densities.sum())) return;
  TrackBelief& belief = beliefs_[track_of_object_[densities.object]];
  // As a Kalman filter of a constant would, but it never ceases to learn: the aspect changes.
  constexpr double kLeastStd_db = 1.0;
  const double variance = belief.rcs_std_db * belief.rcs_std_db;
  const double gain = variance / (variance + kBodyStrength.std_db * kBodyStrength.std_db);
  belief.rcs_dbsm += gain * (m.rcs_dbsm - belief.rcs_dbsm);
  belief.rcs_std_db = std::max(kLeastStd_db, std::sqrt((1.0 - gain) * variance));
}

void MirrorFilter::write_verdict(const Densities& densities, std::size_t i, ClassifiedScan& out) const {
  const double sum = densities.sum();
  if (!(sum > 0.0)) {
    out.set_certain(i, Provenance::kClutter);  // no origin explains it
    return;
  }
  const auto share = [sum](double density) { return static_cast<float>(density / sum); };
  constexpr float kOfAmbiguity = 0.0F;  // the method has no model of ambiguities
  out.set_probabilities(i, {share(densities.moving), share(densities.stationary), share(densities.type1),
                            share(densities.type2), share(densities.clutter), kOfAmbiguity});
  const double unreal = densities.type1 + densities.type2 + densities.clutter;
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
  const double elapsed_s = static_cast<double>(time_ns - before_ns_) * 1e-9;
  for (Pace* const pace : {&tracks_pace_, &mirrors_pace_, &faces_pace_}) pace->advance(elapsed_s);
  before_ns_ = time_ns;
  from_ = viewpoint_of(scan);
  if (!odometry_.advance(time_ns, g.ego_speed_mps, g.ego_yaw_rate_radps)) {
    map_.clear();
    movers_.clear();
  }
  trials_.begin();
  for (std::size_t i = 0; i < count; ++i) {
    kinds_[i] = kind_of(scan, i);
    if (kinds_[i] == Kind::kLeftOut) continue;
    measured_[i] = measured(scan, i, from_);
    measured_[i].cell = map_.grid().fetch_at(odometry_.point_to_frame(measured_[i].position_m));
    trials_.saw(measured_[i].direction, measured_[i].range_m);
  }
  predict_objects(scan);
  update_map(scan, count);
  place_mirrors(map_.reflectors(), odometry_, objects_, from_.sensor_m, config_.classes, mirrors_);
  judge_.begin({from_.sensor_m, from_.sensor_velocity_mps, mirrors_, objects_, &sources_, &odometry_, &movers_,
                &echoes_, &map_.grid()});
  gather_movers(scan, count);
  judge_tracks();
  try_mirrors();

  verdicts_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    out.set_certain(i, Provenance::kUnknown);
    if (kinds_[i] == Kind::kLeftOut || kinds_[i] == Kind::kNotTold) continue;
    const bool moving = kinds_[i] == Kind::kMoving;
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
