// Definition of a lost object.
#include <memory>

#include <gtest/gtest.h>

#include "tests/benchmarks/ghosts/common/lost_objects.hpp"

namespace boresight::bench {
namespace {

using closed_loop::Object;

constexpr std::uint32_t kFirst = 1;

TEST(Tracks, SecondIsLostWhenOnlyPerfectLabelsHoldTheObject) {
  const std::vector<Object> objects = {{1, {20.0, 0.0}, {0.0, 0.0}, 0.0, 4.5, 1.8},
                                       {2, {60.0, 0.0}, {0.0, 0.0}, 0.0, 4.5, 1.8}};
  // The second car is never tracked, the first one in `share` of ten scans.
  const auto second_with = [&objects](int share, bool is_seen = true) {
    const auto tracks = std::make_unique<TrackList>();
    tracks->tracks[0].position_vehicle_m = {20.0F, 0.0F, 0.0F};
    TrackedObjects tracked;
    for (int scan = 0; scan < 10; ++scan) tracked.add(match(*tracks, scan < share ? 1 : 0, objects), objects);
    const auto scan = std::make_unique<ClassifiedScan>();
    scan->number_of_valid_detections = 2;
    scan->provenance[0] = is_seen ? Provenance::kMoving : Provenance::kStationary;
    scan->provenance[1] = Provenance::kMoving;
    simulator::DetectionTruth direct, ghost;
    direct.provenance = Provenance::kMoving;
    ghost.provenance = Provenance::kGhostType1;
    direct.object_id = ghost.object_id = kFirst;
    tracked.add_detections(*scan, {direct, ghost});
    return tracked;
  };
  LostObjects lost;
  lost.add_second(1.0, second_with(10), second_with(4));
  // The second car has no track with perfect labels either.
  EXPECT_EQ(lost.object_seconds, 1u);
  EXPECT_EQ(lost.lost.size(), 1u);
  // The filter's label of its detection is right.
  EXPECT_EQ(lost.lost_though_correct, 1u);
  lost.add_second(1.0, second_with(10), second_with(10));
  EXPECT_EQ(lost.object_seconds, 2u);
  EXPECT_EQ(lost.lost.size(), 1u);
  // With perfect labels none of its detections is classified as moving (a ghost of it is): the second does not count.
  lost.add_second(1.0, second_with(10, false), second_with(4));
  EXPECT_EQ(lost.object_seconds, 2u);
  EXPECT_EQ(lost.lost.size(), 1u);
  EXPECT_EQ(lost.gained, 0u);
  lost.add_second(1.0, second_with(10), second_with(4, false));
  EXPECT_EQ(lost.lost.size(), 2u);
  EXPECT_EQ(lost.lost_though_correct, 1u);
  lost.add_second(1.0, second_with(4), second_with(10));
  EXPECT_EQ(lost.gained, 1u);
  EXPECT_EQ(lost.object_seconds, 3u);
  ASSERT_EQ(lost.of_object.size(), 1u);
  EXPECT_EQ(lost.of_object[kFirst].held, 3u);
  EXPECT_EQ(lost.of_object[kFirst].lost, 2u);
}

TEST(Tracks, ObjectIsJudgedWhileDetectedMovingOrStopped) {
  std::vector<Object> objects = {{kFirst, {20.0, 0.0}, {0.0, 0.0}, 0.0, 4.5, 1.8}};
  const auto tracks = std::make_unique<TrackList>();
  tracks->tracks[0].position_vehicle_m = {20.0F, 0.0F, 0.0F};
  TrackedObjects tracked;
  objects[0].is_hidden = true;
  tracked.add(match(*tracks, 1, objects), objects);
  EXPECT_EQ(tracked.seconds().at(kFirst).scans, 0u);
  objects[0].is_hidden = false;
  tracked.add(match(*tracks, 0, objects), objects);
  EXPECT_EQ(tracked.seconds().at(kFirst).share(), 0.0);
  const auto scan = std::make_unique<ClassifiedScan>();
  scan->number_of_valid_detections = 3;
  simulator::DetectionTruth moves, stands;
  moves.provenance = scan->provenance[0] = Provenance::kMoving;
  stands.provenance = scan->provenance[1] = Provenance::kStationary;
  moves.object_id = stands.object_id = kFirst;
  scan->provenance[2] = Provenance::kGhostType1;
  tracked.add_detections(*scan, {moves, stands, stands});
  EXPECT_EQ(tracked.seconds().at(kFirst).detections, 2u) << "one of the three is classified wrongly";
}

TEST(Tracks, SecondDoesNotCountIfTheObjectAppearsAtItsEnd) {
  std::vector<Object> objects = {{kFirst, {20.0, 0.0}, {0.0, 0.0}, 0.0, 4.5, 1.8}};
  const auto tracks = std::make_unique<TrackList>();
  tracks->tracks[0].position_vehicle_m = {20.0F, 0.0F, 0.0F};
  const auto scan = std::make_unique<ClassifiedScan>();
  scan->number_of_valid_detections = 1;
  simulator::DetectionTruth moves;
  moves.provenance = scan->provenance[0] = Provenance::kMoving;
  moves.object_id = kFirst;
  const auto second_with = [&](int hidden, std::size_t number_of_tracks) {
    TrackedObjects tracked;
    for (int k = 0; k < 20; ++k) {
      objects[0].is_hidden = k < hidden;
      tracked.add(match(*tracks, number_of_tracks, objects), objects);
    }
    tracked.add_detections(*scan, {moves});
    return tracked;
  };
  LostObjects lost;
  lost.add_second(1.0, second_with(16, 1), second_with(16, 0));
  EXPECT_EQ(lost.object_seconds, 0u);
  lost.add_second(2.0, second_with(15, 1), second_with(15, 0));
  EXPECT_EQ(lost.object_seconds, 1u);
  EXPECT_EQ(lost.lost.size(), 1u);
}

TEST(Tracks, ObjectIsLostIfOverHalfOfItsSecondsAre) {
  LostObjects lost;
  lost.of_object = {{1, {4, 2}}, {2, {3, 2}}, {3, {1, 1}}, {4, {9, 0}}};
  EXPECT_EQ(lost.mostly_lost(), 2u);
  EXPECT_EQ(LostObjects{}.mostly_lost(), 0u);
}

TEST(Tracks, LossesByChanceAreSummedPerDraw) {
  LostByChance sum;
  sum += {{1, 0, 2, 0, 0}};
  sum += {{1, 3, 1, 0, 0}};
  EXPECT_EQ(sum.seconds, (std::array<std::size_t, LostByChance::kDraws>{2, 3, 3, 0, 0}));
  EXPECT_EQ(sum.least(), 0u);
  EXPECT_EQ(sum.most(), 3u);
}

}  // namespace
}  // namespace boresight::bench
