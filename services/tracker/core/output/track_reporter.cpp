#include "services/tracker/core/output/track_reporter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/numeric.hpp"
#include "services/tracker/core/output/published_class.hpp"

namespace boresight::tracking {

namespace {

double log_odds(double p) {
  const double q = std::clamp(p, kLeastProbability, 1.0 - kLeastProbability);
  return std::log(q / (1.0 - q));
}

}  // namespace

TrackReporter::TrackReporter(const RadarModel& model, const ReportParameters& parameters, std::size_t max_objects)
    : model_(&model), parameters_(parameters), index_(std::bit_ceil(2 * max_objects + 2)) {
  records_.reserve(max_objects);
  before_.reserve(max_objects);
  tracks_.reserve(kMaxTracks);
}

void TrackReporter::clear() {
  records_.clear();
  tracks_.clear();
  scans_.clear();
}

void TrackReporter::take(std::span<const ObjectEstimate> objects, double elapsed_s) {
  std::swap(records_, before_);
  records_.clear();
  index_.clear();
  for (std::size_t i = 0; i < before_.size(); ++i) static_cast<void>(index_.insert(before_[i].id, static_cast<int>(i)));
  const double time_s = std::max(0.0, elapsed_s);
  scans_.add(model_->radar_index(), time_s);
  tracks_.clear();
  dropped_ = confirmed_ = 0;
  for (const ObjectEstimate& e : objects) {
    Record r{e.id, 0.0, 0.0, log_odds(e.existence)};
    if (const int known = index_.find(e.id); known >= 0) {
      const Record& b = before_[static_cast<std::size_t>(known)];
      r.age_s = b.age_s + time_s;
      r.since_detection_s = e.detected ? 0.0 : b.since_detection_s + time_s;
      r.held_log_odds = std::max(r.held_log_odds, b.held_log_odds - parameters_.hold_log_odds_per_s * time_s);
      r.detectability = b.detectability;
    }
    r.detectability.set(model_->radar_index(),
                        obstacle(model_->sight(*e.component, parameters_.flags.likely), e.shared, parameters_.flags));
    if (records_.size() < records_.capacity()) records_.push_back(r);
    if (e.existence < parameters_.least_existence) continue;
    if (tracks_.size() == kMaxTracks) {
      ++dropped_;
      continue;
    }
    tracks_.emplace_back();
    write_track(e, r, tracks_.back());
    if (tracks_.back().status == TrackStatus::kConfirmed) ++confirmed_;
  }
  // Readers expect the confirmed ones first; each part stays in the order of existence.
  std::sort(tracks_.begin(), tracks_.end(), [](const Track& a, const Track& b) {
    if (a.status != b.status) return a.status == TrackStatus::kConfirmed;
    if (a.existence_probability != b.existence_probability) return a.existence_probability > b.existence_probability;
    return a.tracking_id < b.tracking_id;
  });
}

void TrackReporter::write_track(const ObjectEstimate& e, const Record& r, Track& t) const {
  const LocalAxes& axes = model_->axes();
  const Component<double>& c = *e.component;
  const Box box = model_->box(c);
  const Vector2<double> position = axes.to_vehicle(Vector2<double>{box.centre_m.x(), box.centre_m.y()});
  const Vector2<double> velocity = axes.to_vehicle(c.velocity_mps);
  t = {};
  t.tracking_id = e.id;
  const bool is_confirmed = e.confirmed.value_or(r.held_log_odds >= log_odds(parameters_.confirmed_existence));
  t.status = is_confirmed ? TrackStatus::kConfirmed : TrackStatus::kTentative;
  t.update = e.detected ? TrackUpdate::kMeasured : TrackUpdate::kPredicted;
  const double speed_mps = std::sqrt(squared_norm(velocity));
  t.movement = speed_mps < parameters_.stopped_speed_mps ? MovementState::kStopped : MovementState::kMoving;
  if (const BoxMemory* object = model_->memory(e.id); object != nullptr) publish_class(object->probability, t);
  t.age_s = static_cast<float>(r.age_s);
  t.time_since_update_s = static_cast<float>(r.since_detection_s);
  t.existence_probability = static_cast<float>(e.existence);
  t.mirror_probability = static_cast<float>(std::clamp(c.mirror, 0.0, 1.0));
  t.heading_rad = static_cast<float>(geometry::wrap_angle(box.heading_rad - axes.heading_rad));
  t.length_m = static_cast<float>(box.length_m);
  t.width_m = static_cast<float>(box.width_m);
  t.height_m = static_cast<float>(box.height_m);
  t.position_vehicle_m = {static_cast<float>(position.x), static_cast<float>(position.y),
                          static_cast<float>(0.5 * box.height_m)};
  t.velocity_over_ground_mps = {static_cast<float>(velocity.x), static_cast<float>(velocity.y)};
  t.flags = r.detectability.flags(scans_, parameters_.flags);
  t.number_of_detections = static_cast<std::uint32_t>(std::lround(e.detections));
  const auto set = [&t](std::size_t row, std::size_t column, double value) {
    t.covariance[row * kTrackStateSize + column] = static_cast<float>(value);
    t.covariance[column * kTrackStateSize + row] = static_cast<float>(value);
  };
  const Symmetric2<double> pp =
      axes.to_vehicle(Symmetric2<double>{box.covariance_m2(0, 0), box.covariance_m2(0, 1), box.covariance_m2(1, 1)});
  const Symmetric2<double> vv = axes.to_vehicle(c.velocity_covariance);
  const Matrix2<double> pv = axes.to_vehicle(c.position_velocity_covariance);
  set(0, 0, pp.xx);
  set(0, 1, pp.xy);
  set(1, 1, pp.yy);
  set(2, 2, vv.xx);
  set(2, 3, vv.xy);
  set(3, 3, vv.yy);
  set(0, 2, pv.xx);
  set(0, 3, pv.xy);
  set(1, 2, pv.yx);
  set(1, 3, pv.yy);
  set(4, 4, box.heading_variance_rad2);
  set(5, 5, box.length_variance_m2);
  set(6, 6, box.width_variance_m2);
  const Vector2<double> cl =
      axes.to_vehicle(Vector2<double>{box.centre_length_covariance_m2.x(), box.centre_length_covariance_m2.y()});
  set(0, 5, cl.x);
  set(1, 5, cl.y);
}

void TrackReporter::write(TrackList& out) const {
  out.number_of_tracks = static_cast<std::uint32_t>(tracks_.size());
  out.number_of_confirmed_tracks = confirmed_;
  out.dropped_tracks = dropped_;
  std::copy(tracks_.begin(), tracks_.end(), out.tracks.begin());
}

}  // namespace boresight::tracking
