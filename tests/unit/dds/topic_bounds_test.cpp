// A hostile sender cannot make a reader of tracks or services take memory for what it only announces.
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "generated/service_statusPubSubTypes.h"
#include "generated/track_listPubSubTypes.h"
#include "services/health/dds/sample_bounds.hpp"
#include "tests/unit/dds/samples.hpp"

namespace boresight::dds {
namespace {

using samples::Bytes;

perception::TrackList tracks_sample(std::size_t tracks) {
  perception::TrackList list;
  list.vehicle_name("test car");
  list.tracks().resize(tracks);
  return list;
}

Bytes tracks_bytes(std::size_t tracks) {
  return samples::sent<perception::TrackListPubSubType>(tracks_sample(tracks));
}

diagnostics::ServiceStatus status_with(std::size_t faults, std::size_t sources) {
  diagnostics::ServiceStatus status;
  status.service_name("tracker");
  status.faults().resize(faults);
  for (auto& fault : status.faults()) fault.name("input lost");
  status.sources().resize(sources);
  return status;
}

/// Overwrites the 32-bit number at the only place where `bytes` differ from `other`'s beginning.
void announce(Bytes& bytes, std::size_t offset, std::uint32_t length) {
  std::memcpy(bytes.data() + offset, &length, sizeof(length));
}

TEST(BoundsOfTracks, AcceptAFullListAndAnEmptyOne) {
  for (const std::size_t tracks : {0U, 1U, 128U}) {
    const Bytes bytes = tracks_bytes(tracks);
    ASSERT_FALSE(bytes.empty());
    EXPECT_TRUE(sequences_fit<perception::TrackList>(bytes)) << tracks;
  }
}

TEST(BoundsOfTracks, RefuseMoreThanWasReceivedAndMoreThanTheCapacity) {
  Bytes bytes = tracks_bytes(1);
  constexpr std::size_t kTrack_bytes = 300;
  constexpr std::size_t kBehind_bytes = 4 * sizeof(std::uint32_t);  // two empty sequences and two numbers
  const std::size_t length = bytes.size() - kBehind_bytes - kTrack_bytes - sizeof(std::uint32_t);
  announce(bytes, length, 2);
  EXPECT_FALSE(sequences_fit<perception::TrackList>(bytes));
  announce(bytes, length, 0xFFFFFFFF);
  EXPECT_FALSE(sequences_fit<perception::TrackList>(bytes));
  announce(bytes, length, 1);
  EXPECT_TRUE(sequences_fit<perception::TrackList>(bytes));
  bytes.pop_back();
  EXPECT_FALSE(sequences_fit<perception::TrackList>(bytes)) << "cut";
  Bytes many = tracks_bytes(128);
  const std::size_t at = many.size() - kBehind_bytes - 128 * kTrack_bytes - sizeof(std::uint32_t);
  many.resize(many.size() + kTrack_bytes);
  announce(many, at, 129);
  EXPECT_FALSE(sequences_fit<perception::TrackList>(many)) << "beyond the capacity";
  EXPECT_FALSE(sequences_fit<perception::TrackList>({}));
}

TEST(BoundsOfTracks, RefuseEdgesAndObjectsThatWereNotReceived) {
  perception::TrackList list = tracks_sample(2);
  list.road_edges().resize(4);
  list.path_objects().resize(16);
  const Bytes full = samples::sent<perception::TrackListPubSubType>(list);
  EXPECT_TRUE(sequences_fit<perception::TrackList>(full));
  constexpr std::size_t kObject_bytes = 84, kEdge_bytes = 88;
  const std::size_t objects = full.size() - 16 * kObject_bytes - sizeof(std::uint32_t);
  const std::size_t edges = objects - 2 * sizeof(std::uint32_t) - 4 * kEdge_bytes - sizeof(std::uint32_t);
  for (const std::size_t place : {objects, edges}) {
    Bytes bytes = full;
    announce(bytes, place, 0x00FFFFFF);
    EXPECT_FALSE(sequences_fit<perception::TrackList>(bytes)) << place;
    announce(bytes, place, 17);
    EXPECT_FALSE(sequences_fit<perception::TrackList>(bytes)) << place;
  }
}

TEST(BoundsOfServices, AcceptWhatIsSent) {
  for (const auto& [faults, sources] : {std::pair{0U, 0U}, std::pair{13U, 16U}, std::pair{32U, 1U}}) {
    const Bytes bytes = samples::sent<diagnostics::ServiceStatusPubSubType>(status_with(faults, sources));
    ASSERT_FALSE(bytes.empty());
    EXPECT_TRUE(sequences_fit<diagnostics::ServiceStatus>(bytes)) << faults << " " << sources;
  }
}

TEST(BoundsOfServices, RefuseAnyLengthThatWasNotReceived) {
  const Bytes bytes = samples::sent<diagnostics::ServiceStatusPubSubType>(status_with(2, 1));
  const Bytes without = samples::sent<diagnostics::ServiceStatusPubSubType>(status_with(0, 1));
  std::size_t length_of_faults = 0;
  while (bytes[length_of_faults] == without[length_of_faults]) ++length_of_faults;
  Bytes hostile = bytes;
  announce(hostile, length_of_faults, 0x00FFFFFF);
  EXPECT_FALSE(sequences_fit<diagnostics::ServiceStatus>(hostile));
  announce(hostile, length_of_faults, 33);
  EXPECT_FALSE(sequences_fit<diagnostics::ServiceStatus>(hostile));
  const Bytes no_source = samples::sent<diagnostics::ServiceStatusPubSubType>(status_with(2, 0));
  std::size_t length_of_sources = 0;
  while (bytes[length_of_sources] == no_source[length_of_sources]) ++length_of_sources;
  hostile = bytes;
  announce(hostile, length_of_sources, 2);
  EXPECT_FALSE(sequences_fit<diagnostics::ServiceStatus>(hostile));
}

}  // namespace
}  // namespace boresight::dds
