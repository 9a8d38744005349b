#include "services/boresight/report/recorded_scans.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::report {

namespace {

/// A value that is not known is 0 in the messages of this reader.
float known_or_zero(double value) {
  return std::isfinite(value) ? static_cast<float>(value) : 0.0F;
}

void begin_scan(const score::RunScan& row, ClassifiedScan& scan) {
  scan = {};
  scan.header.source_id = row.radar;
  scan.header.source_sequence = row.scan;
  scan.header.measurement_time_ns = row.time_ns;
  scan.flags = row.flags;
  scan.geometry.sensor_position_vehicle_m = {known_or_zero(row.sensor_x_m), known_or_zero(row.sensor_y_m), 0.0F};
  scan.geometry.ego_speed_mps = known_or_zero(row.ego_speed_mps);
  scan.geometry.ego_yaw_rate_radps = known_or_zero(row.ego_yaw_rate_radps);
}

void put_detection(const score::RunDetection& row, std::size_t i, ClassifiedScan& scan) {
  scan.provenance[i] = row.origin;
  scan.detection_flags[i] = row.rejection;
  scan.x_vehicle_m[i] = static_cast<float>(row.x_vehicle_m);
  scan.y_vehicle_m[i] = static_cast<float>(row.y_vehicle_m);
  scan.range_rate_over_ground_mps[i] = known_or_zero(row.range_rate_over_ground_mps);
  for (std::size_t k = 0; k < kNumberOfOrigins; ++k) scan.origin_probability[k][i] = known_or_zero(row.p_origin[k]);
}

Track track_of(const score::RunTrack& row) {
  const auto both = [](const Eigen::Vector2d& v) {
    return std::array<float, 2>{static_cast<float>(v.x()), static_cast<float>(v.y())};
  };
  Track track{};
  track.status = TrackStatus::kConfirmed;
  track.tracking_id = row.id;
  track.movement = row.movement;
  track.position_vehicle_m = {both(row.position_m)[0], both(row.position_m)[1], 0.0F};
  track.velocity_over_ground_mps = both(row.velocity_mps);
  track.age_s = known_or_zero(row.age_s);
  track.heading_rad = static_cast<float>(row.heading_rad);
  track.length_m = static_cast<float>(row.length_m);
  track.width_m = static_cast<float>(row.width_m);
  track.number_of_detections = row.detections;
  return track;
}

}  // namespace

RecordedScans::RecordedScans(const std::filesystem::path& folder)
    : scans_(folder), detections_(folder, score::RunDetections::Detail::kAll), reflectors_(folder), tracks_(folder) {}

bool RecordedScans::next(ClassifiedScan& scan, TrackList& tracks) {
  score::RunScan row;
  if (!scans_.next(row)) return false;
  detections_.take(row, detection_rows_);
  reflectors_.take(row, reflector_rows_);
  tracks_.take(row, track_rows_);
  begin_scan(row, scan);
  scan.number_of_valid_detections = static_cast<std::uint32_t>(detection_rows_.size());
  for (std::size_t i = 0; i < detection_rows_.size(); ++i) put_detection(detection_rows_[i], i, scan);
  const std::size_t reflectors = std::min(reflector_rows_.size(), kMaxReflectorSegments);
  std::copy_n(reflector_rows_.begin(), reflectors, scan.reflector_segments.begin());
  scan.number_of_reflector_segments = static_cast<std::uint32_t>(reflectors);
  tracks = {};
  tracks.header = scan.header;
  for (const score::RunTrack& track : track_rows_) {
    if (track.confirmed) tracks.tracks[tracks.number_of_tracks++] = track_of(track);
  }
  tracks.number_of_confirmed_tracks = tracks.number_of_tracks;
  return true;
}

}  // namespace boresight::report
