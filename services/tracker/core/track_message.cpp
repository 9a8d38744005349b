#include "services/tracker/core/track_message.hpp"

namespace boresight::tracking {

void write_track(const TrackedObject& track, double stopped_speed_mps, Track& t) {
  const Vector6d& m = track.state.mean;
  t.tracking_id = track.id;
  t.status = track.confirmed ? TrackStatus::kConfirmed : TrackStatus::kTentative;
  t.update = track.detections > 0 ? TrackUpdate::kMeasured : TrackUpdate::kPredicted;
  const double speed = m.segment<2>(2).norm();
  t.movement = speed < stopped_speed_mps ? MovementState::kStopped : MovementState::kMoving;
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
  t.number_of_detections = track.detections;
  t.mirror_probability = 0.0F;
  t.flags = 0;
  t.class_probability = {};
  t.class_probability[static_cast<std::size_t>(t.object_class)] = 1.0F;
  // The extent has no covariance here: its usual errors.
  constexpr float kHeadingStd_rad = 0.1F, kLengthStd_m = 0.5F, kWidthStd_m = 0.3F;
  Eigen::Map<Eigen::Matrix<float, kTrackStateSize, kTrackStateSize, Eigen::RowMajor>> covariance(t.covariance.data());
  covariance.setZero();
  covariance.topLeftCorner<4, 4>() = track.state.covariance.topLeftCorner<4, 4>().cast<float>();
  covariance.diagonal().tail<3>() << kHeadingStd_rad * kHeadingStd_rad, kLengthStd_m * kLengthStd_m,
      kWidthStd_m * kWidthStd_m;
}

}  // namespace boresight::tracking
