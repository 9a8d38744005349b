#include "services/boresight/run/rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "services/boresight/run/counts.hpp"
#include "services/boresight/run/csv_row.hpp"
#include "services/boresight/run/words.hpp"
#include "services/common/alignment_words/alignment_words.hpp"

namespace boresight::run {

namespace {

static_assert(kFlagWords.size() == kNumberOfPipelineFlags && kOriginWords.size() == kNumberOfProvenances &&
              kRejectionWords.size() == kNumberOfRejections && kClassWords.size() == kNumberOfObjectClasses);

/// Of the rows of Track::covariance: x, y, v_x, v_y; the others are heading, length, width.
constexpr std::size_t kNumberOfMotionStates = 4;

template <typename Enum, std::size_t N>
std::string_view word_of(const std::array<std::string_view, N>& words, Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < N ? words[index] : std::string_view("unknown");
}

std::string joined(std::span<const std::string_view> names, std::uint32_t bits) {
  std::string text;
  for (std::size_t bit = 0; bit < names.size(); ++bit) {
    if ((bits >> bit & 1u) == 0) continue;
    if (!text.empty()) text += '+';
    text += names[bit];
  }
  return text;
}

/// The columns with which every row of a scan begins.
CsvRow begin_row(std::string& rows, const ScanResult& result) {
  CsvRow row(rows);
  row.seconds(result.at.since_start_us()).number(result.at.time_ns).number(result.scan.header.source_id);
  row.number(result.number);
  return row;
}

}  // namespace

std::string names_of_flags(std::uint32_t pipeline_flags) {
  return joined(kFlagWords, pipeline_flags);
}

std::string_view name_of_flag(std::size_t bit) {
  return word_of(kFlagWords, bit);
}

std::string names_of_axes(std::uint32_t axes) {
  return joined(kAxisWords, axes);
}

void append_scan(std::string& rows, const ScanResult& result) {
  const ClassifiedScan& scan = result.classified;
  const ScanGeometry& geometry = scan.geometry;
  const bool has_ego = (scan.flags & (pipeline_flag::kNoEgoMotion | pipeline_flag::kEgoMotionStale)) == 0;
  const Provenance* const labels = scan.provenance.data();
  const auto moving = std::count(labels, labels + scan.number_of_valid_detections, Provenance::kMoving);
  CsvRow row = begin_row(rows, result);
  row.number(scan.number_of_valid_detections).word(names_of_flags(scan.flags));
  row.number(geometry.sensor_position_vehicle_m[0]).number(geometry.sensor_position_vehicle_m[1]);
  row.number_if(has_ego, geometry.sensor_velocity_vehicle_mps[0]);
  row.number_if(has_ego, geometry.sensor_velocity_vehicle_mps[1]);
  row.number_if(has_ego, geometry.ego_speed_mps).number_if(has_ego, geometry.ego_yaw_rate_radps);
  row.number(moving).number(result.tracks.number_of_tracks).number(result.tracks.number_of_confirmed_tracks);
  row.word(joined(kTrackerFlagWords, result.tracks.tracker_flags)).number(result.tracks.likelihood_evaluations).end();
}

void append_detections(std::string& rows, const ScanResult& result) {
  const RadarScan& scan = result.scan;
  const ClassifiedScan& classified = result.classified;
  const bool has_elevation = scan.has(scan_field::kElevation);
  const bool has_rcs = scan.has(scan_field::kRcs);
  const bool has_ego = (classified.flags & (pipeline_flag::kNoEgoMotion | pipeline_flag::kEgoMotionStale)) == 0;
  for (std::size_t i = 0; i < classified.number_of_valid_detections; ++i) {
    const std::uint16_t flags = classified.detection_flags[i];
    const bool has_position = std::isfinite(scan.range_m[i]) && std::isfinite(scan.azimuth_rad[i]);
    CsvRow row = begin_row(rows, result);
    row.number(i).number(scan.range_m[i]).number(scan.azimuth_rad[i]);
    row.number_if(has_elevation, scan.elevation_rad[i]).number(scan.range_rate_mps[i]);
    row.number_if(has_rcs, scan.rcs_dbsm[i]);
    row.number_if(has_position, classified.x_vehicle_m[i]).number_if(has_position, classified.y_vehicle_m[i]);
    row.number_if(has_position, classified.z_vehicle_m[i]);
    row.number_if(has_ego && std::isfinite(scan.range_rate_mps[i]), classified.range_rate_over_ground_mps[i]);
    row.word(word_of(kOriginWords, classified.provenance[i]));
    const bool is_classified = classified.provenance[i] != Provenance::kUnknown;
    for (const Provenance origin : kOrigins) row.number_if(is_classified, classified.probability(origin, i));
    row.word(word_of(kRejectionWords, rejection_of(flags))).end();
  }
}

void append_reflectors(std::string& rows, const ScanResult& result) {
  const std::size_t count =
      std::min<std::size_t>(result.classified.number_of_reflector_segments, kMaxReflectorSegments);
  for (std::size_t i = 0; i < count; ++i) {
    const ReflectorSegment& segment = result.classified.reflector_segments[i];
    CsvRow row = begin_row(rows, result);
    row.number(i).number(segment.start_vehicle_m[0]).number(segment.start_vehicle_m[1]);
    row.number(segment.end_vehicle_m[0]).number(segment.end_vehicle_m[1]);
    row.number(segment.residual_std_m).number(segment.number_of_detections).end();
  }
}

void append_tracks(std::string& rows, const ScanResult& result) {
  const std::size_t count = std::min<std::size_t>(result.tracks.number_of_tracks, kMaxTracks);
  for (std::size_t i = 0; i < count; ++i) {
    const Track& track = result.tracks.tracks[i];
    CsvRow row = begin_row(rows, result);
    row.number(track.tracking_id).word(word_of(kStatusWords, track.status)).word(word_of(kUpdateWords, track.update));
    row.word(word_of(kMovementWords, track.movement)).word(word_of(kClassWords, track.object_class));
    row.number(track.existence_probability).number(track.mirror_probability);
    for (const float probability : track.class_probability) row.number(probability);
    row.word(joined(kTrackFlagWords, track.flags)).number(track.age_s).number(track.time_since_update_s);
    for (const float position_m : track.position_vehicle_m) row.number(position_m);
    for (const float velocity_mps : track.velocity_over_ground_mps) row.number(velocity_mps);
    row.number(track.heading_rad).number(track.length_m).number(track.width_m).number(track.height_m);
    const auto covariance = [&track](std::size_t a, std::size_t b) {
      return track.covariance[a * kTrackStateSize + b];
    };
    for (std::size_t k = kNumberOfMotionStates; k < kTrackStateSize; ++k) row.number(std::sqrt(covariance(k, k)));
    row.number(track.number_of_detections);
    for (std::size_t a = 0; a < kNumberOfMotionStates; ++a) {
      for (std::size_t b = a; b < kNumberOfMotionStates; ++b) row.number(covariance(a, b));
    }
    row.end();
  }
}

void append_road_edges(std::string& rows, const ScanResult& result) {
  const std::size_t count = std::min<std::size_t>(result.tracks.number_of_road_edges, kMaxRoadEdges);
  for (std::size_t i = 0; i < count; ++i) {
    const RoadEdge& edge = result.tracks.road_edges[i];
    CsvRow row = begin_row(rows, result);
    row.number(edge.edge_id).word(word_of(kSideWords, edge.side)).word(word_of(kUpdateWords, edge.update));
    row.number(edge.existence_probability).number(edge.age_s).number(edge.time_since_update_s);
    row.number(edge.start_x_m).number(edge.end_x_m);
    for (const float coefficient : edge.coefficients) row.number(coefficient);
    row.number(edge.scatter_std_m).number(edge.number_of_detections);
    for (std::size_t a = 0; a < kRoadEdgeStateSize; ++a) {
      for (std::size_t b = a; b < kRoadEdgeStateSize; ++b) row.number(edge.covariance[a * kRoadEdgeStateSize + b]);
    }
    row.end();
  }
}

void append_collision_warnings(std::string& rows, const ScanResult& result) {
  const std::size_t count = std::min<std::size_t>(result.tracks.number_of_path_objects, kMaxPathObjects);
  for (std::size_t i = 0; i < count; ++i) {
    const PathObject& object = result.tracks.path_objects[i];
    CsvRow row = begin_row(rows, result);
    row.word(word_of(kPathObjectWords, object.kind)).number(object.object_id);
    row.number(static_cast<std::uint32_t>(object.warning)).word(word_of(kUpdateWords, object.update));
    row.number(object.age_s).number(object.existence_probability).number(object.collision_probability);
    row.number(object.time_to_collision_s).number(object.time_to_collision_std_s);
    row.number(object.required_deceleration_mps2).number(object.path_offset_m).number(object.path_offset_std_m);
    row.number(object.length_m).number(object.width_m);
    for (const float position_m : object.position_vehicle_m) row.number(position_m);
    for (const float velocity_mps : object.velocity_over_ground_mps) row.number(velocity_mps);
    for (const float covariance_m2 : object.position_covariance_m2) row.number(covariance_m2);
    row.end();
  }
}

void append_estimate(std::string& rows, const EstimateResult& result) {
  const AlignmentEstimate& message = result.message;
  CsvRow row(rows);
  row.seconds(result.at.since_start_us()).number(result.at.time_ns).number(message.header.source_id);
  row.word(word_of(kStateWords, message.state)).number(message.speed_scale);
  row.number(message.vehicle_yaw_rad).number(message.vehicle_pitch_rad).number(message.vehicle_roll_rad);
  for (Eigen::Index i = 0; i < 3; ++i) row.number(static_cast<float>(result.rotation_vehicle_rad(i)));
  for (Eigen::Index a = 0; a < result.covariance.rows(); ++a) {
    for (Eigen::Index b = a; b < result.covariance.cols(); ++b) row.number(static_cast<float>(result.covariance(a, b)));
  }
  row.word(names_of_axes(message.observable)).number(message.kpis.inlier_ratio).number(message.step_change.count);
  for (const AlignmentValue& value : {message.nuisance.load_pitch_rad, message.nuisance.range_rate_scale}) {
    row.number(value.value).number(value.std);
  }
  row.word(alignment_words::key_of(message.reason)).word(alignment_words::key_of(message.finding)).end();
}

}  // namespace boresight::run
