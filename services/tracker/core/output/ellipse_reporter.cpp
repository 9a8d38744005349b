#include "services/tracker/core/output/ellipse_reporter.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

EllipseReporter::EllipseReporter(double confirmed_existence) : confirmed_existence_(confirmed_existence) {
  tracks_.reserve(kMaxTracks);
}

void EllipseReporter::take(std::span<const ObjectEstimate> objects, double /*elapsed_s*/) {
  tracks_.clear();
  for (const ObjectEstimate& e : objects) {
    if (tracks_.size() == kMaxTracks) break;
    const Component<double>& c = *e.component;
    const Symmetric2<double> x = extent(c);
    const double mean = 0.5 * trace(x), half = 0.5 * (x.xx - x.yy);
    const double spread = std::sqrt(half * half + x.xy * x.xy);
    Track t{};
    t.tracking_id = e.id;
    t.status = e.existence > confirmed_existence_ ? TrackStatus::kConfirmed : TrackStatus::kTentative;
    t.update = e.detected ? TrackUpdate::kMeasured : TrackUpdate::kPredicted;
    t.movement = MovementState::kUnknown;
    t.class_probability[static_cast<std::size_t>(ObjectClass::kUnknown)] = 1.0F;
    t.existence_probability = static_cast<float>(e.existence);
    t.heading_rad = static_cast<float>(0.5 * std::atan2(2.0 * x.xy, x.xx - x.yy));
    t.length_m = static_cast<float>(2.0 * std::sqrt(mean + spread));
    t.width_m = static_cast<float>(2.0 * std::sqrt(std::max(0.0, mean - spread)));
    t.position_vehicle_m = {static_cast<float>(c.position_m.x), static_cast<float>(c.position_m.y), 0.0F};
    t.velocity_over_ground_mps = {static_cast<float>(c.velocity_mps.x), static_cast<float>(c.velocity_mps.y)};
    t.number_of_detections = static_cast<std::uint32_t>(std::lround(e.detections));
    const auto set = [&t](std::size_t row, std::size_t column, double value) {
      t.covariance[row * kTrackStateSize + column] = static_cast<float>(value);
      t.covariance[column * kTrackStateSize + row] = static_cast<float>(value);
    };
    set(0, 0, c.position_covariance.xx);
    set(0, 1, c.position_covariance.xy);
    set(1, 1, c.position_covariance.yy);
    set(2, 2, c.velocity_covariance.xx);
    set(2, 3, c.velocity_covariance.xy);
    set(3, 3, c.velocity_covariance.yy);
    set(0, 2, c.position_velocity_covariance.xx);
    set(0, 3, c.position_velocity_covariance.xy);
    set(1, 2, c.position_velocity_covariance.yx);
    set(1, 3, c.position_velocity_covariance.yy);
    tracks_.push_back(t);
  }
}

void EllipseReporter::write(TrackList& out) const {
  out.number_of_tracks = static_cast<std::uint32_t>(tracks_.size());
  out.number_of_confirmed_tracks = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    out.tracks[i] = tracks_[i];
    if (tracks_[i].status == TrackStatus::kConfirmed) ++out.number_of_confirmed_tracks;
  }
}

}  // namespace boresight::tracking
