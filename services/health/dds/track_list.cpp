#include "services/health/dds/track_list.hpp"

#include <algorithm>

#include "services/health/dds/enumeration.hpp"

namespace boresight::dds {

namespace {

// A new layout of the message needs a look at the IDL.
static_assert(TrackList::kVersion == 2 && sizeof(Track) == 288 && sizeof(MessageHeader) == 104);
static_assert(kMaxTracks == 128 && kNumberOfStages == 4);
static_assert(static_cast<int>(TrackStatus::kConfirmed) == perception::CONFIRMED);
static_assert(static_cast<int>(TrackUpdate::kPredicted) == perception::PREDICTED);
static_assert(static_cast<int>(MovementState::kStopped) == perception::STOPPED);
static_assert(static_cast<int>(ObjectClass::kVan) == perception::VAN);
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
}

}  // namespace boresight::dds
