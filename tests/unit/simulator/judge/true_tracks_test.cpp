// The tracks of a tracker that knows everything of the objects that radars have detected.
#include "services/simulator/judge/true_tracks.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::judge {
namespace {

Object true_object(std::uint32_t id, double length_m, double width_m, bool is_hidden = false) {
  return {id, {30.0 + id, -4.0}, {12.0, 1.5}, 0.3, length_m, width_m, is_hidden};
}

class TrueTracksTest : public testing::Test {
 protected:
  const TrackList& written(double t_s, const std::vector<Object>& objects) {
    tracks_.write(t_s, objects, *list_);
    return *list_;
  }
  TrueTracks tracks_;
  std::unique_ptr<TrackList> list_ = std::make_unique<TrackList>();
};

TEST_F(TrueTracksTest, AnObjectIsKnownFromItsFirstDirectEchoOn) {
  EXPECT_EQ(written(1.0, {true_object(3, 4.5, 1.8, true)}).number_of_tracks, 0U) << "hidden until it is detected";
  EXPECT_LT(tracks_.age_s(3, 1.0), 0.0);
  const TrackList& list = written(2.0, {true_object(3, 4.5, 1.8)});
  ASSERT_EQ(list.number_of_tracks, 1U);
  EXPECT_EQ(list.number_of_confirmed_tracks, 1U);
  EXPECT_EQ(list.tracks[0].age_s, 0.0F);
  EXPECT_EQ(tracks_.age_s(3, 2.0), 0.0);
  EXPECT_FLOAT_EQ(written(3.5, {true_object(3, 4.5, 1.8)}).tracks[0].age_s, 1.5F);
}

TEST_F(TrueTracksTest, AHiddenObjectIsForgottenAndBeginsAnew) {
  written(1.0, {true_object(3, 4.5, 1.8)});
  EXPECT_EQ(written(2.0, {true_object(3, 4.5, 1.8, true)}).number_of_tracks, 0U);
  EXPECT_LT(tracks_.age_s(3, 2.0), 0.0);
  EXPECT_EQ(written(4.0, {true_object(3, 4.5, 1.8)}).tracks[0].age_s, 0.0F);
}

TEST_F(TrueTracksTest, ATrackHasTheTrueState) {
  const Object o = true_object(9, 4.5, 1.8);
  const Track& t = written(1.0, {o}).tracks[0];
  EXPECT_EQ(t.tracking_id, 9U);
  EXPECT_EQ(t.status, TrackStatus::kConfirmed);
  EXPECT_EQ(t.movement, MovementState::kMoving);
  EXPECT_EQ(t.existence_probability, 1.0F);
  EXPECT_FLOAT_EQ(t.position_vehicle_m[0], 39.0F);
  EXPECT_FLOAT_EQ(t.position_vehicle_m[1], -4.0F);
  EXPECT_FLOAT_EQ(t.velocity_over_ground_mps[0], 12.0F);
  EXPECT_FLOAT_EQ(t.velocity_over_ground_mps[1], 1.5F);
  EXPECT_FLOAT_EQ(t.heading_rad, 0.3F);
  EXPECT_FLOAT_EQ(t.length_m, 4.5F);
  EXPECT_FLOAT_EQ(t.width_m, 1.8F);
  for (const float covariance : t.covariance) EXPECT_EQ(covariance, 0.0F);
}

TEST_F(TrueTracksTest, TheClassFollowsTheSize) {
  struct Case {
    double length_m;
    ObjectClass expected;
  };
  for (const Case& c : {Case{0.5, ObjectClass::kPedestrian}, Case{1.8, ObjectClass::kTwoWheeler},
                        Case{4.5, ObjectClass::kCar}, Case{12.0, ObjectClass::kTruck}}) {
    const Track& t = written(1.0, {true_object(1, c.length_m, 0.6)}).tracks[0];
    EXPECT_EQ(t.object_class, c.expected) << c.length_m;
    EXPECT_EQ(t.class_probability[static_cast<std::size_t>(c.expected)], 1.0F);
    float sum = 0.0F;
    for (const float p : t.class_probability) sum += p;
    EXPECT_EQ(sum, 1.0F);
  }
}

TEST_F(TrueTracksTest, AListHoldsAsManyAsThereIsRoomForAndAllAreKnown) {
  std::vector<Object> objects;
  for (std::uint32_t id = 1; id <= kMaxTracks + 20; ++id) objects.push_back(true_object(id, 4.5, 1.8));
  const TrackList& list = written(1.0, objects);
  EXPECT_EQ(list.number_of_tracks, kMaxTracks);
  EXPECT_EQ(list.number_of_confirmed_tracks, kMaxTracks);
  EXPECT_EQ(tracks_.age_s(kMaxTracks + 20, 2.5), 1.5) << "without room in the list it ages all the same";
  EXPECT_EQ(written(3.0, {objects.back()}).tracks[0].age_s, 2.0F);
}

TEST_F(TrueTracksTest, NothingIsLeftOfTheListBefore) {
  written(1.0, {true_object(1, 12.0, 2.5), true_object(2, 4.5, 1.8)});
  list_->flags = list_->tracker_flags = 7;
  const TrackList& list = written(1.1, {true_object(2, 4.5, 1.8)});
  ASSERT_EQ(list.number_of_tracks, 1U);
  EXPECT_EQ(list.tracks[0].tracking_id, 2U);
  EXPECT_EQ(list.tracks[0].object_class, ObjectClass::kCar);
  EXPECT_EQ(list.flags + list.tracker_flags, 0U);
}

}  // namespace
}  // namespace boresight::judge
