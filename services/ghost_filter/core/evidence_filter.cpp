#include "services/ghost_filter/core/evidence_filter.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/messages/radar_scan.hpp"
#include "services/ghost_filter/core/evidence/evidence_of.hpp"
#include "services/ghost_filter/core/pass_on.hpp"

namespace boresight::ghosts {

namespace {

/// Images of all objects in all mirrors would be 24,000; few of them are in front of a mirror.
constexpr std::size_t kMostImages = 1024;

bool is_finite(const CorrectedScan& scan, std::size_t i) {
  return std::isfinite(scan.x_vehicle_m[i] + scan.y_vehicle_m[i] + scan.range_m[i] + scan.azimuth_vehicle_rad[i] +
                       scan.range_rate_mps[i] + scan.range_rate_over_ground_mps[i] + scan.range_std_m[i] +
                       scan.azimuth_std_rad[i] + scan.range_rate_std_mps[i]);
}

SensorVerdict verdict_of(const CorrectedScan& scan, std::size_t i) {
  const std::uint16_t flags = scan.detection_flags[i];
  SensorVerdict v{(flags & corrected_flag::kDoubted) != 0, (flags & corrected_flag::kAmbiguous) != 0, {}};
  const auto existence = static_cast<double>(scan.existence_probability[i]);
  if ((scan.fields & scan_field::kExistence) != 0 && std::isfinite(existence)) v.existence = existence;
  return v;
}

/// Probabilities of all origins. What is not moving is shared out by what explains it, and named after the largest.
void write(double real, const Counts& counts, const Expected& expected, double other_intensity, std::size_t i,
           ClassifiedScan& out) {
  const double all = expected.images_type1 + expected.images_type2 + other_intensity;
  const double unreal = 1.0 - real;
  const auto share = [&](double intensity) { return static_cast<float>(unreal * intensity / all); };
  // The same range and range rate at other azimuths: an azimuth ambiguity, a side lobe or smear of one echo.
  const bool is_ring = counts.ring > counts.company;
  out.set_probabilities(i, {static_cast<float>(real), 0.0F, share(expected.images_type1), share(expected.images_type2),
                            is_ring ? 0.0F : share(other_intensity), is_ring ? share(other_intensity) : 0.0F});
  if (real >= unreal) {
    out.provenance[i] = Provenance::kMoving;
    return;
  }
  Provenance largest = is_ring ? Provenance::kAmbiguity : Provenance::kClutter;
  for (const Provenance image : {Provenance::kGhostType1, Provenance::kGhostType2}) {
    if (out.probability(image, i) > out.probability(largest, i)) largest = image;
  }
  out.provenance[i] = largest;
}

}  // namespace

EvidenceFilter::EvidenceFilter(const EvidenceConfig& config)
    : config_(config),
      counter_(config.counts, static_cast<std::uint32_t>(config.levels.past_scans.back())),
      map_(config.map),
      expecting_(config_.classes, config_.intensity),
      tracks_(std::make_unique<TrackList>()) {
  judged_.reserve(kMaxDetections);
  candidates_.reserve(kMaxDetections);
  counts_.resize(kMaxDetections);
  seen_.reserve(kMaxDetections);
  expected_.resize(kMaxDetections);
  mirrors_.reserve(kMaxReflectorSegments);
  objects_.reserve(kMaxTracks);
  images_.reserve(kMostImages);
}

void EvidenceFilter::add_tracks(const TrackList& tracks) {
  tracks_->header = tracks.header;
  tracks_->number_of_tracks = std::min<std::uint32_t>(tracks.number_of_tracks, kMaxTracks);
  std::copy_n(tracks.tracks.begin(), tracks_->number_of_tracks, tracks_->tracks.begin());
  has_list_ = true;
}

bool EvidenceFilter::has_tracks(std::int64_t time_ns, ClassifiedScan& out) const {
  if (!has_list_) {
    out.flags |= pipeline_flag::kNoTracks;
    return false;
  }
  const double age_s = static_cast<double>(time_ns - tracks_->header.measurement_time_ns) * 1e-9;
  if (std::abs(age_s) <= config_.tracks_max_age_s) return true;
  out.flags |= pipeline_flag::kTracksStale;
  return false;
}

const EvidenceWeights& EvidenceFilter::weights_of(std::uint32_t radar_id) const {
  for (const RadarWeights& each : config_.radars) {
    if (each.radar_id == radar_id) return each.weights;
  }
  return config_.weights;
}

void EvidenceFilter::gather(const CorrectedScan& scan, std::size_t count, ClassifiedScan& out) {
  judged_.clear();
  candidates_.clear();
  seen_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t flags = scan.detection_flags[i];
    out.set_certain(i, Provenance::kUnknown);
    if ((flags & corrected_flag::kRejected) != 0 || !is_finite(scan, i)) continue;
    const Eigen::Vector2d position(scan.x_vehicle_m[i], scan.y_vehicle_m[i]);
    const auto range = static_cast<double>(scan.range_m[i]);
    const double range_std = static_cast<double>(scan.range_std_m[i]);
    const double across_std = range * static_cast<double>(scan.azimuth_std_rad[i]);
    if ((flags & corrected_flag::kStationary) != 0) {
      out.set_certain(i, Provenance::kStationary);
      map_.add(odometry_.point_to_frame(position), std::max(range_std, across_std), scan.header.measurement_time_ns);
      continue;
    }
    if ((flags & corrected_flag::kMoving) == 0) continue;
    const auto azimuth = static_cast<double>(scan.azimuth_vehicle_rad[i]);
    const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
    candidates_.push_back({scan.range_m[i], scan.azimuth_vehicle_rad[i], scan.range_rate_mps[i],
                           scan.range_rate_over_ground_mps[i], odometry_.point_to_frame(position).cast<float>(),
                           odometry_.vector_to_frame(direction).cast<float>()});
    const Eigen::Vector2d across(-direction.y(), direction.x());
    const auto rate_std = static_cast<double>(scan.range_rate_std_mps[i]);
    seen_.push_back({position, direction,
                     range_std * range_std * direction * direction.transpose() +
                         across_std * across_std * across * across.transpose(),
                     range, static_cast<double>(scan.range_rate_over_ground_mps[i]), rate_std * rate_std,
                     kReachStds * std::max(range_std, across_std)});
    judged_.push_back({static_cast<std::uint32_t>(i), {}});
  }
}

void EvidenceFilter::expect(const CorrectedScan& scan, bool has_tracks) {
  const ScanGeometry& g = scan.geometry;
  const Eigen::Vector2d sensor(g.sensor_position_vehicle_m[0], g.sensor_position_vehicle_m[1]);
  const Eigen::Vector2d velocity(g.sensor_velocity_vehicle_mps[0], g.sensor_velocity_vehicle_mps[1]);
  objects_.clear();
  images_.clear();
  if (has_tracks && !seen_.empty()) {
    SightOfImages sight{sensor, velocity, {}, 0.0};
    for (const SeenDetection& d : seen_) {
      sight.places.add(d.position_m);
      sight.reach_m = std::max(sight.reach_m, d.reach_m);
    }
    const double elapsed_s =
        static_cast<double>(scan.header.measurement_time_ns - tracks_->header.measurement_time_ns) * 1e-9;
    predict_objects(*tracks_, elapsed_s, g, objects_);
    place_mirrors(map_.reflectors(), odometry_, config_.intensity, mirrors_);
    place_images(objects_, mirrors_, sight, config_.intensity.mirrored_existence, images_);
  }
  expecting_.find(seen_, sensor, objects_, images_, std::span(expected_).first(seen_.size()));
}

void EvidenceFilter::judge(const CorrectedScan& scan, bool has_tracks, ClassifiedScan& out) {
  const EvidenceWeights& weights = weights_of(scan.header.source_id);
  for (std::size_t k = 0; k < judged_.size(); ++k) {
    JudgedEvidence& judged = judged_[k];
    const std::size_t i = judged.index;
    judged.levels = levels_of(counts_[k], verdict_of(scan, i), expected_[k], has_tracks, config_);
    const double real = 1.0 / (1.0 + std::exp(-posterior_log_odds(weights, judged.levels)));
    write(real, counts_[k], expected_[k], config_.intensity.other_intensity, i, out);
    out.moving_log_likelihood_ratio[i] = static_cast<float>(log_likelihood_ratio(weights, judged.levels));
  }
}

void EvidenceFilter::classify(const CorrectedScan& scan, ClassifiedScan& out) {
  const std::size_t count = pass_on(scan, out);
  const ScanGeometry& g = scan.geometry;
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  if (!odometry_.advance(time_ns, static_cast<double>(g.ego_speed_mps), static_cast<double>(g.ego_yaw_rate_radps))) {
    map_.clear();
    counter_.clear();
  }
  gather(scan, count, out);
  map_.update(time_ns);
  // A distrusted scan has no candidates, and must not count as a scan in which others are missing.
  if ((scan.flags & pipeline_flag::kDistrusted) == 0) {
    counter_.count(time_ns, candidates_, counts_);
    const bool tracks_are_known = has_tracks(time_ns, out);
    expect(scan, tracks_are_known);
    judge(scan, tracks_are_known, out);
  }
  write_segments(map_.reflectors(), odometry_, out);
}

}  // namespace boresight::ghosts
