#include "services/tracker/core/classes/track_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

namespace {

[[nodiscard]] double covariance(const Track& track, std::size_t row, std::size_t column) {
  return static_cast<double>(track.covariance[row * kTrackStateSize + column]);
}

[[nodiscard]] Vector2<double> velocity_of(const Track& track) {
  return {static_cast<double>(track.velocity_over_ground_mps[0]),
          static_cast<double>(track.velocity_over_ground_mps[1])};
}

}  // namespace

TrackPoints::TrackPoints(const ClassEvidenceParameters& parameters) : parameters_(parameters) {
  points_.reserve(kMaxDetections);
  by_track_.reserve(kMaxDetections);
  owner_.reserve(kMaxDetections);
  begin_.reserve(kMaxTracks + 1);
}

double TrackPoints::gated_distance_m(const ClusterPoint& point, const Track& track) const {
  constexpr double kOutside = std::numeric_limits<double>::infinity();
  const Vector2<double> velocity = velocity_of(track);
  const double residual_mps = point.range_rate_mps - dot(point.sight, velocity);
  const double speed_mps = std::sqrt(squared_norm(velocity));
  if (!(std::abs(residual_mps) <= parameters_.gate_mps + parameters_.gate_by_speed * speed_mps)) return kOutside;
  const double c = std::cos(static_cast<double>(track.heading_rad)),
               s = std::sin(static_cast<double>(track.heading_rad));
  const double x = point.position_m.x - static_cast<double>(track.position_vehicle_m[0]);
  const double y = point.position_m.y - static_cast<double>(track.position_vehicle_m[1]);
  const double along = std::max(0.0, std::abs(c * x + s * y) - 0.5 * static_cast<double>(track.length_m));
  const double across = std::max(0.0, std::abs(-s * x + c * y) - 0.5 * static_cast<double>(track.width_m));
  const double distance = std::hypot(along, across);
  const double std_m = std::sqrt(std::max(0.0, covariance(track, 0, 0) + covariance(track, 1, 1)));
  const double gate_m =
      parameters_.gate_m + std::min(std_m, parameters_.gate_most_std_m) + parameters_.gate_rad * point.range_m;
  return distance <= gate_m ? distance : kOutside;
}

void TrackPoints::read(const ClassifiedScan& scan, std::size_t radar, const RadarLevels& levels) {
  points_.clear();
  if ((scan.flags & pipeline_flag::kDistrusted) != 0) return;
  const bool has_height =
      (scan.fields & scan_field::kElevation) != 0 && (scan.flags & pipeline_flag::kNoElevation) == 0;
  for (std::size_t i = 0; i < scan.number_of_valid_detections && i < kMaxDetections; ++i) {
    if (scan.provenance[i] == Provenance::kUnknown || (scan.detection_flags[i] & corrected_flag::kMoving) == 0)
      continue;
    ClusterPoint& point = points_.emplace_back();
    const auto azimuth_rad = static_cast<double>(scan.azimuth_vehicle_rad[i]);
    point.position_m = {static_cast<double>(scan.x_vehicle_m[i]), static_cast<double>(scan.y_vehicle_m[i])};
    point.sight = {std::cos(azimuth_rad), std::sin(azimuth_rad)};
    point.range_m = static_cast<double>(scan.range_m[i]);
    point.range_rate_mps = static_cast<double>(scan.range_rate_over_ground_mps[i]);
    if (has_height) point.height_m = static_cast<double>(scan.z_vehicle_m[i]);
    if ((scan.fields & scan_field::kRcs) != 0) {
      point.strength_db = levels.strength_db(radar, point.range_m, static_cast<double>(scan.rcs_dbsm[i]));
    }
    if ((scan.fields & scan_field::kSnr) != 0) {
      point.snr_db = levels.snr_db(radar, point.range_m, static_cast<double>(scan.snr_db[i]));
    }
  }
}

void TrackPoints::find(const ClassifiedScan& scan, std::size_t radar, const RadarLevels& levels,
                       const TrackList& list) {
  read(scan, radar, levels);
  owner_.clear();
  begin_.assign(list.number_of_tracks + 1, 0);
  for (const ClusterPoint& point : points_) {
    double nearest_m = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = list.number_of_tracks;
    for (std::uint32_t k = 0; k < list.number_of_tracks; ++k) {
      const double distance_m = gated_distance_m(point, list.tracks[k]);
      if (!(distance_m < nearest_m)) continue;
      nearest_m = distance_m;
      nearest = k;
    }
    owner_.push_back(nearest);
    if (nearest < list.number_of_tracks) ++begin_[nearest];
  }
  // Numbers become ends; filling from behind turns them into begins.
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  by_track_.resize(begin_.back());
  for (std::size_t i = points_.size(); i-- > 0;) {
    if (owner_[i] < list.number_of_tracks) by_track_[--begin_[owner_[i]]] = points_[i];
  }
}

TrackObservation observation_of(const Track& track, const ClassifiedScan& scan, const RadarConfig& radar) {
  TrackObservation observation;
  const ScanGeometry& g = scan.geometry;
  observation.position_m = {static_cast<double>(track.position_vehicle_m[0]),
                            static_cast<double>(track.position_vehicle_m[1])};
  observation.velocity_mps = velocity_of(track);
  observation.velocity_covariance_m2ps2 = {covariance(track, 2, 2), covariance(track, 2, 3), covariance(track, 3, 3)};
  observation.heading_rad = static_cast<double>(track.heading_rad);
  observation.sensor_m = {static_cast<double>(g.sensor_position_vehicle_m[0]),
                          static_cast<double>(g.sensor_position_vehicle_m[1])};
  const Vector2<double> from_sensor = observation.position_m - observation.sensor_m;
  const double yaw_rad =
      std::atan2(static_cast<double>(g.sensor_to_vehicle[3]), static_cast<double>(g.sensor_to_vehicle[0]));
  const double azimuth_rad = geometry::wrap_angle(std::atan2(from_sensor.y, from_sensor.x) - yaw_rad);
  const FieldOfView& view = radar.field_of_view;
  const bool in_view = azimuth_rad > view.azimuth_min_rad && azimuth_rad < view.azimuth_max_rad &&
                       std::sqrt(squared_norm(from_sensor)) < view.range_max_m;
  observation.in_view = in_view && (track.flags & track_flag::kOccluded) == 0 ? 1.0 : 0.0;
  return observation;
}

}  // namespace boresight::tracking
