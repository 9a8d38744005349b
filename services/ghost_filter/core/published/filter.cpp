#include "services/ghost_filter/core/published/filter.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/geometry/ego_step.hpp"
#include "services/ghost_filter/core/pass_on.hpp"

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

Eigen::Vector2d point(const std::array<float, 2>& p) {
  return {p[0], p[1]};
}

}  // namespace

Filter::Filter(const Config& config) : config_(config), finder_(config), tracks_(std::make_unique<TrackList>()) {}

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
  for (std::size_t i = 0; i < number_of_segments_; ++i) {
    const ReflectorSegment& segment = segments_[i];
    const auto share =
        geometry::crossing(sensor, position, point(segment.start_vehicle_m), point(segment.end_vehicle_m));
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
  map_.advance(time_ns, scan.geometry.ego_speed_mps, scan.geometry.ego_yaw_rate_radps, config_.memory_s);
  for (std::size_t i = 0; i < count; ++i) {
    if (takes_part(scan, i) && is_stationary(scan, i)) map_.add({scan.x_vehicle_m[i], scan.y_vehicle_m[i]});
  }
  const std::int64_t age_ns = time_ns - found_ns_;
  if (age_ns < 0 || static_cast<double>(age_ns) * 1e-9 >= config_.update_period_s) {
    const std::span<const ReflectorSegment> found = finder_.find(map_.points());
    std::copy(found.begin(), found.end(), segments_.begin());
    number_of_segments_ = found.size();
    found_ns_ = time_ns;
  } else {
    // A scan of another radar a few milliseconds later: the reflectors are the same, seen from farther on.
    const double elapsed_s = static_cast<double>(time_ns - segments_time_ns_) * 1e-9;
    const geometry::EgoStep step =
        geometry::ego_step(scan.geometry.ego_speed_mps, scan.geometry.ego_yaw_rate_radps, elapsed_s);
    const auto moved = [&step](const std::array<float, 2>& p) -> std::array<float, 2> {
      const Eigen::Vector2f to = step.move_point(point(p)).cast<float>();
      return {to.x(), to.y()};
    };
    for (std::size_t i = 0; i < number_of_segments_; ++i) {
      segments_[i].start_vehicle_m = moved(segments_[i].start_vehicle_m);
      segments_[i].end_vehicle_m = moved(segments_[i].end_vehicle_m);
    }
  }
  segments_time_ns_ = time_ns;
}

void Filter::classify(const CorrectedScan& scan, ClassifiedScan& out) {
  const std::size_t count = pass_on(scan, out);
  update_segments(scan, count);
  std::copy_n(segments_.begin(), number_of_segments_, out.reflector_segments.begin());
  out.number_of_reflector_segments = static_cast<std::uint32_t>(number_of_segments_);

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
