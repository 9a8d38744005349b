// Assignment of tracks to objects, and tracks that live on ghosts.
#include <memory>

#include "services/simulator/judge/false_tracks.hpp"
#include "services/simulator/judge/hidden.hpp"

namespace boresight::judge {
namespace {

class Tracks : public testing::Test {
 protected:
  static Object car(std::uint32_t id, double x, double y) { return {id, {x, y}, {0.0, 0.0}, 0.0, 4.5, 1.8}; }
  void add_track(std::uint32_t id, float x, float y) {
    Track& track = tracks_->tracks[tracks_->number_of_tracks++];
    track = {};
    track.tracking_id = id;
    track.status = TrackStatus::kConfirmed;
    track.position_vehicle_m = {x, y, 0.0f};
    track.length_m = 4.0f;
    track.width_m = 1.8f;
    track.number_of_detections = 1;
    tracks_->number_of_confirmed_tracks = tracks_->number_of_tracks;
  }
  void add_detection(float x, float y, Provenance label, Provenance truth) {
    const std::size_t i = scan_->number_of_valid_detections++;
    scan_->x_vehicle_m[i] = x;
    scan_->y_vehicle_m[i] = y;
    scan_->provenance[i] = label;
    truth_.emplace_back().provenance = truth;
  }
  [[nodiscard]] Matching matched() const { return match(*tracks_, tracks_->number_of_confirmed_tracks, objects_); }
  void add_scans(int count) {
    for (int i = 0; i < count; ++i) false_tracks_.add(0.1 * i, *scan_, truth_, *tracks_, matched());
  }
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  std::unique_ptr<ClassifiedScan> scan_ = std::make_unique<ClassifiedScan>();
  std::vector<simulator::DetectionTruth> truth_;
  std::vector<Object> objects_;
  FalseTracks false_tracks_;
};

TEST_F(Tracks, AreAssignedToTheNearestObjectOneToOne) {
  objects_ = {car(1, 20.0, 0.0), car(2, 20.0, 3.6), car(3, 60.0, 0.0)};
  add_track(7, 20.5f, 3.0f);
  add_track(8, 57.0f, 0.3f);
  add_track(9, 64.0f, 0.0f);
  const Matching m = matched();
  // The first car has no track, although the track of the car beside it is near.
  EXPECT_EQ(m.track_of_object, (std::vector<std::size_t>{kNone, 0, 1}));
  EXPECT_EQ(m.object_of_track, (std::vector<std::size_t>{1, 2, kNone}));
}

TEST_F(Tracks, InABoxAreAssignedToThatObjectOrToNone) {
  objects_ = {car(1, 20.0, 0.0), car(2, 20.0, 3.6)};
  add_track(7, 20.0f, 3.6f);
  add_track(8, 20.0f, 2.8f);
  // The second track is in the second car's box and 1.9 m beside the first car.
  EXPECT_EQ(matched().object_of_track, (std::vector<std::size_t>{1, kNone}));
  objects_[1].is_hidden = true;
  EXPECT_EQ(matched().object_of_track, (std::vector<std::size_t>{1, 0}));
}

TEST_F(Tracks, AreAssignedToAHiddenObjectOnlyWithoutAVisibleOne) {
  objects_ = {car(1, 20.0, 0.0), car(2, 20.0, 3.6)};
  add_track(7, 20.0f, 1.3f);
  EXPECT_EQ(matched().object_of_track, (std::vector<std::size_t>{0}));
  objects_[0].is_hidden = true;
  EXPECT_EQ(matched().object_of_track, (std::vector<std::size_t>{1}));
  objects_.pop_back();
  EXPECT_EQ(matched().object_of_track, (std::vector<std::size_t>{0}));
}

TEST(LastSeen, HidesAnObjectWithoutDirectReflectionForHalfASecond) {
  std::vector<Object> objects = {{1, {20.0, 0.0}, {0.0, 0.0}, 0.0, 4.5, 1.8},
                                 {2, {60.0, 0.0}, {0.0, 0.0}, 0.0, 4.5, 1.8}};
  LastSeen last_seen;
  const auto is_hidden_after = [&](double t_s, Provenance provenance) {
    simulator::DetectionTruth truth;
    truth.object_id = 1;
    truth.provenance = provenance;
    last_seen.mark(t_s, {truth}, objects);
    EXPECT_TRUE(objects[1].is_hidden);
    return objects[0].is_hidden;
  };
  EXPECT_TRUE(is_hidden_after(0.0, Provenance::kGhostType2)) << "a ghost is no direct reflection";
  EXPECT_FALSE(is_hidden_after(0.1, Provenance::kMoving));
  EXPECT_FALSE(is_hidden_after(0.6, Provenance::kGhostType2));
  EXPECT_TRUE(is_hidden_after(0.7, Provenance::kGhostType2));
  EXPECT_FALSE(is_hidden_after(0.8, Provenance::kStationary)) << "the object stopped";
}

TEST_F(Tracks, LiveOnGhostsEvenCloseToTheirObject) {
  objects_ = {car(1, 20.0, 0.0)};
  add_track(7, 20.0f, 0.0f);
  add_track(8, 25.2f, 0.0f);
  add_detection(18.0f, 0.0f, Provenance::kMoving, Provenance::kMoving);
  add_detection(25.0f, 0.0f, Provenance::kMoving, Provenance::kGhostType1);
  add_detection(26.0f, 0.0f, Provenance::kMoving, Provenance::kGhostType1);
  add_detection(26.0f, 0.5f, Provenance::kMoving, Provenance::kMoving);
  add_scans(5);
  EXPECT_EQ(false_tracks_.long_ghost_tracks().size(), 0u);
  add_scans(1);
  ASSERT_EQ(false_tracks_.long_ghost_tracks().size(), 1u);
  EXPECT_EQ(false_tracks_.long_ghost_tracks().front().tracking_id, 8u);
  EXPECT_EQ(false_tracks_.longest_ghost_track_scans(), 6u);
  EXPECT_EQ(false_tracks_.long_other_tracks(), 0u);
}

TEST_F(Tracks, DoNotLiveOnDetectionsClassifiedAsGhosts) {
  add_track(8, 25.0f, 0.0f);
  add_detection(25.0f, 0.0f, Provenance::kGhostType2, Provenance::kGhostType2);
  add_scans(10);
  EXPECT_EQ(false_tracks_.long_ghost_tracks().size(), 0u);
  add_detection(25.0f, 0.5f, Provenance::kMoving, Provenance::kClutter);
  add_scans(6);
  EXPECT_EQ(false_tracks_.long_ghost_tracks().size(), 0u);
  EXPECT_EQ(false_tracks_.long_other_tracks(), 1u);
}

}  // namespace
}  // namespace boresight::judge
