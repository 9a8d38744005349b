// A track list leaves the ECU whole.
#include "services/health/dds/track_list.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "generated/track_listPubSubTypes.h"
#include "tests/unit/dds/samples.hpp"

namespace boresight::dds {
namespace {

constexpr std::int64_t kTime_ns = 1'700'000'000'250'000'000;

TrackList list_of(std::uint32_t number_of_tracks) {
  TrackList list = samples::distinct<TrackList>();
  list.header.time_source = TimeSource::kSensorFreeRunning;
  list.number_of_tracks = number_of_tracks;
  for (Track& track : list.tracks) {
    track.status = TrackStatus::kConfirmed;
    track.update = TrackUpdate::kPredicted;
    track.movement = MovementState::kStationary;
    track.object_class = ObjectClass::kTwoWheeler;
  }
  list.number_of_road_edges = list.number_of_path_objects = 2;
  for (RoadEdge& edge : list.road_edges) {
    edge.side = RoadSide::kRight;
    edge.update = TrackUpdate::kPredicted;
  }
  for (PathObject& object : list.path_objects) {
    object.kind = PathObjectKind::kTrack;
    object.update = TrackUpdate::kPredicted;
  }
  return list;
}

perception::TrackList sample_of(const TrackList& list) {
  perception::TrackList sample;
  fill(sample, list, "test car", kTime_ns);
  return sample;
}

samples::Bytes list_bytes(const TrackList& list) {
  return samples::sent<perception::TrackListPubSubType>(sample_of(list));
}

TEST(TrackListByDds, HasEveryFieldOfEveryTrackInItsPlace) {
  const auto list = std::make_unique<TrackList>(list_of(kMaxTracks));
  const perception::TrackList got = samples::received<perception::TrackListPubSubType>(sample_of(*list));
  EXPECT_EQ(got.vehicle_name(), "test car");
  EXPECT_EQ(got.time_ns(), kTime_ns);
  EXPECT_EQ(got.measurement_time_ns(), list->header.measurement_time_ns);
  EXPECT_EQ(got.time_source(), perception::SENSOR_FREE_RUNNING);
  EXPECT_EQ(got.layout_version(), list->header.version);
  EXPECT_EQ(got.radar_id(), list->header.source_id);
  EXPECT_EQ(got.sequence_number(), list->header.sequence);
  EXPECT_EQ(got.scan_sequence_number(), list->header.source_sequence);
  for (std::size_t i = 0; i < kNumberOfStages; ++i) {
    EXPECT_EQ(got.stages()[i].begin_ns(), list->header.stages[i].begin_ns) << i;
    EXPECT_EQ(got.stages()[i].end_ns(), list->header.stages[i].end_ns) << i;
  }
  EXPECT_EQ(got.number_of_confirmed_tracks(), list->number_of_confirmed_tracks);
  EXPECT_EQ(got.flags(), list->flags);
  EXPECT_EQ(got.dropped_tracks(), list->dropped_tracks);
  EXPECT_EQ(got.tracker_flags(), list->tracker_flags);
  EXPECT_EQ(got.likelihood_evaluations(), list->likelihood_evaluations);
  ASSERT_EQ(got.tracks().size(), kMaxTracks);
  for (std::size_t i = 0; i < kMaxTracks; ++i) {
    const Track& track = list->tracks[i];
    const perception::Track& t = got.tracks()[i];
    EXPECT_EQ(t.tracking_id(), track.tracking_id);
    EXPECT_EQ(t.status(), perception::CONFIRMED);
    EXPECT_EQ(t.update(), perception::PREDICTED);
    EXPECT_EQ(t.movement(), perception::STATIONARY);
    EXPECT_EQ(t.object_class(), perception::TWO_WHEELER);
    EXPECT_EQ(t.age_s(), track.age_s);
    EXPECT_EQ(t.time_since_update_s(), track.time_since_update_s);
    EXPECT_EQ(t.existence_probability(), track.existence_probability);
    EXPECT_EQ(t.mirror_probability(), track.mirror_probability);
    EXPECT_EQ(t.heading_rad(), track.heading_rad);
    EXPECT_EQ(t.length_m(), track.length_m);
    EXPECT_EQ(t.width_m(), track.width_m);
    EXPECT_EQ(t.height_m(), track.height_m);
    EXPECT_EQ(t.position_vehicle_m(), track.position_vehicle_m);
    EXPECT_EQ(t.velocity_over_ground_mps(), track.velocity_over_ground_mps);
    EXPECT_EQ(t.number_of_detections(), track.number_of_detections);
    EXPECT_EQ(t.flags(), track.flags);
    EXPECT_EQ(t.class_probability(), track.class_probability);
    EXPECT_EQ(t.covariance(), track.covariance);
  }
}

TEST(TrackListByDds, HasTheRoadEdgesAndPathObjects) {
  const auto list = std::make_unique<TrackList>(list_of(3));
  const perception::TrackList got = samples::received<perception::TrackListPubSubType>(sample_of(*list));
  ASSERT_EQ(got.road_edges().size(), 2u);
  ASSERT_EQ(got.path_objects().size(), 2u);
  EXPECT_EQ(got.number_of_collision_warnings(), list->number_of_collision_warnings);
  EXPECT_EQ(got.dropped_path_objects(), list->dropped_path_objects);
  for (std::size_t i = 0; i < 2; ++i) {
    const RoadEdge& edge = list->road_edges[i];
    const perception::RoadEdge& e = got.road_edges()[i];
    EXPECT_EQ(e.edge_id(), edge.edge_id);
    EXPECT_EQ(e.side(), perception::RIGHT_SIDE);
    EXPECT_EQ(e.update(), perception::PREDICTED);
    EXPECT_EQ(e.existence_probability(), edge.existence_probability);
    EXPECT_EQ(e.start_x_m(), edge.start_x_m);
    EXPECT_EQ(e.end_x_m(), edge.end_x_m);
    EXPECT_EQ(e.coefficients(), edge.coefficients);
    EXPECT_EQ(e.covariance(), edge.covariance);
    EXPECT_EQ(e.number_of_detections(), edge.number_of_detections);
    const PathObject& object = list->path_objects[i];
    const perception::PathObject& o = got.path_objects()[i];
    EXPECT_EQ(o.object_id(), object.object_id);
    EXPECT_EQ(o.kind(), perception::TRACKED_OBJECT);
    EXPECT_EQ(o.warning(), object.warning);
    EXPECT_EQ(o.collision_probability(), object.collision_probability);
    EXPECT_EQ(o.time_to_collision_s(), object.time_to_collision_s);
    EXPECT_EQ(o.time_to_collision_std_s(), object.time_to_collision_std_s);
    EXPECT_EQ(o.position_vehicle_m(), object.position_vehicle_m);
    EXPECT_EQ(o.velocity_over_ground_mps(), object.velocity_over_ground_mps);
    EXPECT_EQ(o.position_covariance_m2(), object.position_covariance_m2);
  }
}

TEST(TrackListByDds, DependsOnEveryByteOfTheMessage) {
  const auto list = std::make_unique<TrackList>(list_of(3));
  const std::size_t tracks = offsetof(TrackList, tracks);
  std::vector<std::size_t> unused;
  samples::append(unused, offsetof(MessageHeader, reserved), 7);
  EXPECT_EQ(samples::without_effect(*list, 0, sizeof(MessageHeader) + 6 * sizeof(std::uint32_t), list_bytes), unused);
  EXPECT_TRUE(samples::without_effect(*list, tracks, tracks + 3 * sizeof(Track), list_bytes).empty());
  EXPECT_EQ(samples::without_effect(*list, tracks + 3 * sizeof(Track), tracks + 4 * sizeof(Track), list_bytes).size(),
            sizeof(Track))
      << "behind the last track";
}

TEST(TrackListByDds, HoldsNoMoreThanItsCapacity) {
  const auto list = std::make_unique<TrackList>(list_of(kMaxTracks + 1));
  EXPECT_EQ(sample_of(*list).tracks().size(), kMaxTracks);
  EXPECT_EQ(samples::received<perception::TrackListPubSubType>(sample_of(*list)).tracks().size(), kMaxTracks);
  EXPECT_TRUE(sample_of(list_of(0)).tracks().empty());
  // One datagram of UDP, without fragments of DDS.
  EXPECT_LT(list_bytes(*list).size(), 60'000U);
}

TEST(TrackListByDds, UsesTheMemoryOfTheSampleAgain) {
  perception::TrackList sample;
  fill(sample, list_of(kMaxTracks), "test car", kTime_ns);
  const perception::Track* const memory = sample.tracks().data();
  fill(sample, list_of(1), "test car", kTime_ns);
  EXPECT_EQ(sample.tracks().size(), 1U);
  fill(sample, list_of(kMaxTracks), "test car", kTime_ns);
  EXPECT_EQ(sample.tracks().data(), memory);
}

TEST(TrackListByDds, KeepsWhatIsNoNumber) {
  const auto list = std::make_unique<TrackList>(list_of(1));
  list->tracks[0].heading_rad = std::numeric_limits<float>::quiet_NaN();
  list->tracks[0].covariance[0] = std::numeric_limits<float>::infinity();
  const auto got = samples::received<perception::TrackListPubSubType>(sample_of(*list));
  EXPECT_TRUE(std::isnan(got.tracks().at(0).heading_rad()));
  EXPECT_EQ(got.tracks().at(0).covariance()[0], std::numeric_limits<float>::infinity());
}

TEST(TrackListByDds, ReplacesAnImpossibleValueOfAnEnumeration) {
  const auto list = std::make_unique<TrackList>(list_of(1));
  list->tracks[0].object_class = static_cast<ObjectClass>(77);
  list->tracks[0].movement = static_cast<MovementState>(77);
  const perception::Track track = sample_of(*list).tracks().at(0);
  EXPECT_EQ(track.object_class(), perception::CLASS_UNKNOWN);
  EXPECT_EQ(track.movement(), perception::MOVEMENT_UNKNOWN);
}

}  // namespace
}  // namespace boresight::dds
