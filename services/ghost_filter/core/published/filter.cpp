#include "services/ghost_filter/core/published/filter.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/geometry/ego_step.hpp"
#include "services/ghost_filter/core/pass_on.hpp"
#include "services/ghost_filter/core/reflectors/reflector_map.hpp"

namespace boresight::ghosts::published {

namespace {

/// Probabilities by label of a moving detection. Choice: the method has labels only, and one of them is wrong in one
/// case of twenty. That is left for the other answers that the tests can give.
constexpr OriginProbabilities kOfMoving = {0.95F, 0.0F, 0.025F, 0.025F, 0.0F, 0.0F};
constexpr OriginProbabilities kOfType1 = {0.05F, 0.0F, 0.95F, 0.0F, 0.0F, 0.0F};
constexpr OriginProbabilities kOfType2 = {0.05F, 0.0F, 0.0F, 0.95F, 0.0F, 0.0F};
/// Half width (rad) of the sector abeam in which moving and stationary detections have the same range rate. The scene
/// of Le Ba Thanh 2023 is faster; at walking pace its constant would classify every detection as moving.
constexpr double kAbeam = 0.15;
constexpr std::size_t kCapacity = 8192;  // points of a search

Eigen::Vector2d point(const std::array<float, 2>& p) {
  return {p[0], p[1]};
}

}  // namespace

Filter::Filter(const Config& config)
    : config_(config), finder_(config, kCapacity), tracks_(std::make_unique<TrackList>()) {
  points_.reserve(StationaryTiles::kTiles * StationaryTiles::kMostPoints);
  segments_.reserve(kMaxReflectorSegments);
}

void Filter::add_tracks(const TrackList& tracks) {
  // Only what is used: the whole capacity would be copied for a handful of tracks.
  tracks_->header = tracks.header;
  tracks_->number_of_tracks = std::min<std::uint32_t>(tracks.number_of_tracks, kMaxTracks);
  std::copy_n(tracks.tracks.begin(), tracks_->number_of_tracks, tracks_->tracks.begin());
  has_tracks_ = true;
}

void Filter::predict_tracks(const CorrectedScan& scan) {
  number_of_ellipses_ = 0;
  const double elapsed_s =
      static_cast<double>(scan.header.measurement_time_ns - tracks_->header.measurement_time_ns) * 1e-9;
  if (!has_tracks_ || std::abs(elapsed_s) > config_.tracks_max_age_s) return;
  const geometry::EgoStep step =
      geometry::ego_step(scan.geometry.ego_speed_mps, scan.geometry.ego_yaw_rate_radps, elapsed_s);
  const double turn = static_cast<double>(scan.geometry.ego_yaw_rate_radps) * elapsed_s;
  for (std::size_t i = 0; i < tracks_->number_of_tracks; ++i) {
    const Track& track = tracks_->tracks[i];
    if (track.status != TrackStatus::kConfirmed) continue;
    const Eigen::Vector2d position(track.position_vehicle_m[0], track.position_vehicle_m[1]);
    const Eigen::Vector2d moved = position + elapsed_s * point(track.velocity_over_ground_mps);
    ellipses_[number_of_ellipses_++] = {step.move_point(moved), track.heading_rad - turn,
                                        0.5 * static_cast<double>(track.length_m) + config_.ellipse_margin_m,
                                        0.5 * static_cast<double>(track.width_m) + config_.ellipse_margin_m};
  }
}

bool Filter::takes_part(const CorrectedScan& scan, std::size_t i) const {
  // Without ego motion the corrector says neither.
  const std::uint16_t flags = scan.detection_flags[i];
  return (flags & corrected_flag::kRejected) == 0 &&
         (flags & (corrected_flag::kMoving | corrected_flag::kStationary)) != 0;
}

bool Filter::is_stationary(const CorrectedScan& scan, std::size_t i) const {
  const double over_ground = scan.range_rate_over_ground_mps[i];
  const double expected = static_cast<double>(scan.range_rate_mps[i]) - over_ground;
  const double least = std::min(config_.min_expected_range_rate_mps, kAbeam * std::abs(scan.geometry.ego_speed_mps));
  return std::abs(over_ground) < config_.max_range_rate_mps && std::abs(expected) >= least;
}

Provenance Filter::judge_moving(const Eigen::Vector2d& sensor, const Eigen::Vector2d& position) const {
  const Eigen::Vector2d sight = position - sensor;
  const double range = sight.norm();
  if (range < 1e-3) return Provenance::kMoving;
  const Eigen::Vector2d from = odometry_.point_to_frame(sensor), to = odometry_.point_to_frame(position);
  for (const Segment& segment : segments_) {
    const auto share = geometry::crossing(from, to, segment.start_m, segment.end_m);
    if (share && (1.0 - *share) * range > config_.type2_margin_m) return Provenance::kGhostType2;
  }
  for (std::size_t i = 0; i < number_of_ellipses_; ++i) {
    const auto stretch = geometry::stretch_within(ellipses_[i], sensor, sight / range);
    if (stretch && stretch->enter_m > 0.0 && range > stretch->leave_m + config_.type1_margin_m)
      return Provenance::kGhostType1;
  }
  return Provenance::kMoving;
}

void Filter::update_segments(const CorrectedScan& scan, std::size_t count) {
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  if (!odometry_.advance(time_ns, static_cast<double>(scan.geometry.ego_speed_mps),
                         static_cast<double>(scan.geometry.ego_yaw_rate_radps))) {
    tiles_.clear();
    segments_.clear();
    found_ns_ = 0;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!takes_part(scan, i) || !is_stationary(scan, i)) continue;
    tiles_.add(odometry_.point_to_frame({scan.x_vehicle_m[i], scan.y_vehicle_m[i]}), time_ns);
  }
  const std::int64_t age_ns = time_ns - found_ns_;
  if (age_ns < 0 || static_cast<double>(age_ns) * 1e-9 >= config_.update_period_s) {
    points_.clear();
    tiles_.collect(time_ns - static_cast<std::int64_t>(config_.memory_s * 1e9), points_);
    // The clusters are longer along the vehicle.
    for (Eigen::Vector2d& p : points_) p = odometry_.point_to_vehicle(p);
    segments_.clear();
    for (Segment each : finder_.find(points_)) {
      each.start_m = odometry_.point_to_frame(each.start_m);
      each.end_m = odometry_.point_to_frame(each.end_m);
      segments_.push_back(each);
    }
    found_ns_ = time_ns;
  }
}

void Filter::classify(const CorrectedScan& scan, ClassifiedScan& out) {
  const std::size_t count = pass_on(scan, out);
  update_segments(scan, count);
  write_segments(segments_, odometry_, out);

  const std::int64_t time_ns = scan.header.measurement_time_ns;
  predict_tracks(scan);
  if (!has_tracks_) {
    out.flags |= pipeline_flag::kNoTracks;
  } else if (std::abs(static_cast<double>(time_ns - tracks_->header.measurement_time_ns)) * 1e-9 >
             config_.tracks_max_age_s) {
    out.flags |= pipeline_flag::kTracksStale;
  }

  const Eigen::Vector2d sensor(scan.geometry.sensor_position_vehicle_m[0], scan.geometry.sensor_position_vehicle_m[1]);
  for (std::size_t i = 0; i < count; ++i) {
    if (!takes_part(scan, i)) {
      out.set_certain(i, Provenance::kUnknown);
    } else if (is_stationary(scan, i)) {
      out.set_certain(i, Provenance::kStationary);
    } else {
      const Provenance label = judge_moving(sensor, {scan.x_vehicle_m[i], scan.y_vehicle_m[i]});
      out.provenance[i] = label;
      out.set_probabilities(i, label == Provenance::kMoving       ? kOfMoving
                               : label == Provenance::kGhostType1 ? kOfType1
                                                                  : kOfType2);
      const float moving = out.probability(Provenance::kMoving, i);
      out.moving_log_likelihood_ratio[i] = std::log(moving / (1.0F - moving));
    }
  }
}

}  // namespace boresight::ghosts::published
