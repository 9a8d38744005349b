#include "services/health/dds/track_list.hpp"

#include <algorithm>

#include "services/health/dds/enumeration.hpp"

namespace boresight::dds {

namespace {

// A new layout of the message needs a look at the IDL.
static_assert(TrackList::kVersion == 3 && sizeof(Track) == 288 && sizeof(MessageHeader) == 104);
static_assert(sizeof(RoadEdge) == 84 && sizeof(PathObject) == 76 && kMaxRoadEdges == 4 && kMaxPathObjects == 16);
static_assert(kMaxTracks == 128 && kNumberOfStages == 4);
static_assert(static_cast<int>(TrackStatus::kConfirmed) == perception::CONFIRMED);
static_assert(static_cast<int>(TrackUpdate::kPredicted) == perception::PREDICTED);
static_assert(static_cast<int>(MovementState::kStopped) == perception::STOPPED);
static_assert(static_cast<int>(ObjectClass::kVan) == perception::VAN);
static_assert(static_cast<int>(RoadSide::kRight) == perception::RIGHT_SIDE);
static_assert(static_cast<int>(PathObjectKind::kTrack) == perception::TRACKED_OBJECT);
static_assert(static_cast<int>(TimeSource::kUserArrival) == perception::USER_ARRIVAL);

void fill_track(perception::Track& out, const Track& track) {
  out.tracking_id(track.tracking_id);
  out.status(enumerator(track.status, perception::CONFIRMED));
  out.update(enumerator(track.update, perception::PREDICTED));
  out.movement(enumerator(track.movement, perception::STOPPED));
  out.object_class(enumerator(track.object_class, perception::VAN));
  out.age_s(track.age_s);
  out.time_since_update_s(track.time_since_update_s);
  out.existence_probability(track.existence_probability);
  out.mirror_probability(track.mirror_probability);
  out.heading_rad(track.heading_rad);
  out.length_m(track.length_m);
  out.width_m(track.width_m);
  out.height_m(track.height_m);
  out.position_vehicle_m(track.position_vehicle_m);
  out.velocity_over_ground_mps(track.velocity_over_ground_mps);
  out.number_of_detections(track.number_of_detections);
  out.flags(track.flags);
  out.class_probability(track.class_probability);
  out.covariance(track.covariance);
}

void fill_edge(perception::RoadEdge& out, const RoadEdge& edge) {
  out.edge_id(edge.edge_id);
  out.side(enumerator(edge.side, perception::RIGHT_SIDE));
  out.update(enumerator(edge.update, perception::PREDICTED));
  out.age_s(edge.age_s);
  out.time_since_update_s(edge.time_since_update_s);
  out.existence_probability(edge.existence_probability);
  out.start_x_m(edge.start_x_m);
  out.end_x_m(edge.end_x_m);
  out.scatter_std_m(edge.scatter_std_m);
  out.coefficients(edge.coefficients);
  out.covariance(edge.covariance);
  out.number_of_detections(edge.number_of_detections);
}

void fill_object(perception::PathObject& out, const PathObject& object) {
  out.object_id(object.object_id);
  out.kind(enumerator(object.kind, perception::TRACKED_OBJECT));
  out.update(enumerator(object.update, perception::PREDICTED));
  out.warning(object.warning);
  out.age_s(object.age_s);
  out.existence_probability(object.existence_probability);
  out.collision_probability(object.collision_probability);
  out.time_to_collision_s(object.time_to_collision_s);
  out.time_to_collision_std_s(object.time_to_collision_std_s);
  out.required_deceleration_mps2(object.required_deceleration_mps2);
  out.path_offset_m(object.path_offset_m);
  out.path_offset_std_m(object.path_offset_std_m);
  out.length_m(object.length_m);
  out.width_m(object.width_m);
  out.position_vehicle_m(object.position_vehicle_m);
  out.velocity_over_ground_mps(object.velocity_over_ground_mps);
  out.position_covariance_m2(object.position_covariance_m2);
}

}  // namespace

void fill(perception::TrackList& out, const TrackList& list, const std::string& vehicle_name, std::int64_t time_ns) {
  out.vehicle_name(vehicle_name);
  out.time_ns(time_ns);
  out.measurement_time_ns(list.header.measurement_time_ns);
  out.time_source(enumerator(list.header.time_source, perception::USER_ARRIVAL));
  out.layout_version(list.header.version);
  out.radar_id(list.header.source_id);
  out.sequence_number(list.header.sequence);
  out.scan_sequence_number(list.header.source_sequence);
  for (std::size_t i = 0; i < kNumberOfStages; ++i) {
    out.stages()[i].begin_ns(list.header.stages[i].begin_ns);
    out.stages()[i].end_ns(list.header.stages[i].end_ns);
  }
  out.number_of_confirmed_tracks(list.number_of_confirmed_tracks);
  out.flags(list.flags);
  out.dropped_tracks(list.dropped_tracks);
  out.tracker_flags(list.tracker_flags);
  out.likelihood_evaluations(list.likelihood_evaluations);
  const std::size_t tracks = std::min<std::size_t>(list.number_of_tracks, kMaxTracks);
  out.tracks().resize(tracks);
  for (std::size_t i = 0; i < tracks; ++i) fill_track(out.tracks()[i], list.tracks[i]);
  const std::size_t edges = std::min<std::size_t>(list.number_of_road_edges, kMaxRoadEdges);
  out.road_edges().resize(edges);
  for (std::size_t i = 0; i < edges; ++i) fill_edge(out.road_edges()[i], list.road_edges[i]);
  out.number_of_collision_warnings(list.number_of_collision_warnings);
  out.dropped_path_objects(list.dropped_path_objects);
  const std::size_t objects = std::min<std::size_t>(list.number_of_path_objects, kMaxPathObjects);
  out.path_objects().resize(objects);
  for (std::size_t i = 0; i < objects; ++i) fill_object(out.path_objects()[i], list.path_objects[i]);
}

}  // namespace boresight::dds
