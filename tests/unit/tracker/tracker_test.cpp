#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

class TrackerTest : public testing::Test {
 protected:
  TrackerTest() { std::memset(static_cast<void*>(list_.get()), 0xCD, sizeof(TrackList)); }
  const TrackList& list() {
    tracker_.write(*list_);
    return *list_;
  }
  /// One scan of radar 1 with an object at p, or without.
  void step(const Eigen::Vector2d& p, const Eigen::Vector2d& v, bool seen = true) {
    scene_.begin(now_);
    if (seen) scene_.add(p, v);
    tracker_.step(*scene_.scan);
    now_ += 50 * kMillisecond;
  }
  Tracker tracker_{two_radars(), RulesConfig{}};
  Scene scene_;
  std::unique_ptr<TrackList> list_ = std::make_unique<TrackList>();
  std::int64_t now_ = 1'000'000 * kMillisecond;
};

TEST_F(TrackerTest, ConfirmsFourOfSix) {
  const Eigen::Vector2d v(0.0, 0.0);
  int scans = 0;
  for (const bool seen : {true, false, true, false, true}) {
    step({30.0 + 0.4 * scans++, 0.0}, {8.0, 0.0}, seen);
    EXPECT_EQ(list().number_of_confirmed_tracks, 0u) << "after " << scans;
    EXPECT_EQ(list().number_of_tracks, 1u);
  }
  step({30.0 + 0.4 * scans++, 0.0}, {8.0, 0.0});
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  EXPECT_EQ(list().tracks[0].status, TrackStatus::kConfirmed);
  EXPECT_EQ(list().tracks[0].update, TrackUpdate::kMeasured);
  EXPECT_GT(list().tracks[0].tracking_id, 0u);
}

TEST_F(TrackerTest, WhatCannotBeConfirmedAnyMoreIsGivenUp) {
  step({30.0, 0.0}, {8.0, 0.0});
  for (int i = 0; i < 3; ++i) step({}, {}, false);
  EXPECT_EQ(list().number_of_tracks, 0u);
}

/// How far a last detection, beside the track by 1.5 m, moves it.
double moved_by(double ghost_probability) {
  return changed_by_last_scan(
      [ghost_probability](Scene& scene, int i, bool is_last) {
        scene.add({30.0 + 0.4 * i, is_last ? 1.5 : 0.0}, {8.0, 0.0}, Provenance::kMoving,
                  is_last ? ghost_probability : 0.0);
      },
      [](const Track& track) { return track.position_vehicle_m[1]; });
}

TEST(TrackerUpdate, WhatMayBeAGhostHardlyMovesATrack) {
  EXPECT_GT(moved_by(0.0), 0.1);
  EXPECT_GT(moved_by(0.9), 0.0);
  EXPECT_LT(moved_by(0.9), 0.2 * moved_by(0.0));
}

TEST_F(TrackerTest, VehiclesThatPassEachOtherKeepTheirNames) {
  // In adjacent lanes: for some scans their detections are one cluster by place.
  std::map<bool, std::set<std::uint32_t>> names;  // by whether it comes towards us
  for (int i = 0; i < 80; ++i) {
    const double t = 0.05 * i;
    scene_.begin(now_);
    for (const double part : {-0.7, 0.7}) {
      scene_.add({25.0 + 12.0 * t, part}, {12.0, 0.0});
      scene_.add({95.0 - 14.0 * t, 3.2 + part}, {-14.0, 0.0});
    }
    tracker_.step(*scene_.scan);
    now_ += 50 * kMillisecond;
    if (i < 20) continue;
    EXPECT_EQ(list().number_of_confirmed_tracks, 2u) << i;
    for (std::size_t k = 0; k < list_->number_of_confirmed_tracks; ++k) {
      names[list_->tracks[k].velocity_over_ground_mps[0] < 0.0F].insert(list_->tracks[k].tracking_id);
    }
  }
  EXPECT_EQ(names[false].size(), 1u);
  EXPECT_EQ(names[true].size(), 1u);
}

TEST_F(TrackerTest, BothEndsOfALongVehicleAreOneTrack) {
  // 12 m long, seen from the side; it reflects at its ends and in the middle, farther apart than a cluster reaches.
  for (int i = 0; i < 60; ++i) {
    const double x = 15.0 + 0.05 * 12.0 * i;
    scene_.begin(now_);
    for (const double end : {0.0, 0.8, 5.5, 6.5, 11.0, 12.0}) scene_.add({x + end, 6.0}, {12.0, 0.0});
    tracker_.step(*scene_.scan);
    now_ += 50 * kMillisecond;
  }
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  EXPECT_EQ(list().number_of_tracks, 1u);
  // Each end was taken for a car of its own at first; what is too long shrinks slowly.
  EXPECT_NEAR(list().tracks[0].length_m, 12.0, 3.5);
  EXPECT_NEAR(list().tracks[0].position_vehicle_m[0], 15.0 + 0.05 * 12.0 * 59 + 6.0, 2.0);
  EXPECT_EQ(list().tracks[0].object_class, ObjectClass::kTruck);
}

TEST_F(TrackerTest, ALongVehicleIsFoundByOneOfItsEnds) {
  // 16 m long, all of its side is seen; then but the front end.
  double x = 5.0;
  for (int i = 0; i < 60; ++i) {
    scene_.begin(now_);
    for (double part = 0.0; part <= 16.0; part += 2.0) scene_.add({x + part, 8.0}, {6.0, 0.0});
    tracker_.step(*scene_.scan);
    now_ += 50 * kMillisecond;
    x += 0.3;
  }
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  EXPECT_NEAR(list().tracks[0].length_m, 16.0, 3.5);
  for (int i = 0; i < 10; ++i) {
    scene_.begin(now_);
    scene_.add({x + 16.0, 8.0}, {6.0, 0.0});
    tracker_.step(*scene_.scan);
    now_ += 50 * kMillisecond;
    x += 0.3;
    ASSERT_EQ(list().number_of_tracks, 1u);
    EXPECT_EQ(list().tracks[0].number_of_detections, 1u);
  }
  EXPECT_NEAR(list().tracks[0].position_vehicle_m[0], x - 0.3 + 8.0, 3.0);
}

TEST_F(TrackerTest, WhatLiesBehindACarInTheLineOfSightMakesItNoLonger) {
  // A car straight ahead and its type-1 ghost, which the filter does not tell: a detour of 8 m by a rail.
  for (int i = 0; i < 60; ++i) {
    const double x = 20.0 + 0.05 * 12.0 * i;
    scene_.begin(now_);
    for (const double part : {-0.7, 0.7}) {
      scene_.add({x + 8.0, part}, {12.0, 0.0});
      if (i >= 2) scene_.add({x, part}, {12.0, 0.0});
    }
    tracker_.step(*scene_.scan);
    now_ += 50 * kMillisecond;
  }
  ASSERT_GE(list().number_of_confirmed_tracks, 1u);
  const auto end = list().tracks.begin() + list().number_of_confirmed_tracks;
  const Track& nearest = *std::min_element(list().tracks.begin(), end, [](const Track& a, const Track& b) {
    return a.position_vehicle_m[0] < b.position_vehicle_m[0];
  });
  EXPECT_NEAR(nearest.position_vehicle_m[0], 20.0 + 0.05 * 12.0 * 59 + 2.25, 1.0) << "the car, though seen later";
  EXPECT_NEAR(nearest.length_m, 4.5, 0.5);
}

TEST_F(TrackerTest, EstimatesPlaceVelocityAndBox) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  // A car of 4.5 m by 1.8 m passes in front, seen at its rear and its right side.
  Eigen::Vector2d centre(25.0, 8.0);
  const Eigen::Vector2d velocity(9.0, -2.0);
  for (int i = 0; i < 60; ++i) {
    scene_.begin(now_);
    const Eigen::Vector2d along = velocity.normalized(), right(along.y(), -along.x());
    for (const double a : {-2.25, 0.0, 2.25}) {
      scene_.add(centre + a * along + 0.9 * right + 0.1 * Eigen::Vector2d(normal(random), normal(random)), velocity);
    }
    for (const double b : {-0.9, 0.0}) {
      scene_.add(centre - 2.25 * along + b * right + 0.1 * Eigen::Vector2d(normal(random), normal(random)), velocity);
    }
    tracker_.step(*scene_.scan);
    now_ += 50 * kMillisecond;
    centre += 0.05 * velocity;
  }
  centre -= 0.05 * velocity;
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  ASSERT_EQ(list().number_of_tracks, 1u);
  const Track& track = list().tracks[0];
  EXPECT_NEAR(track.position_vehicle_m[0], centre.x(), 0.8);
  EXPECT_NEAR(track.position_vehicle_m[1], centre.y(), 0.8);
  EXPECT_NEAR(track.velocity_over_ground_mps[0], velocity.x(), 0.5);
  EXPECT_NEAR(track.velocity_over_ground_mps[1], velocity.y(), 1.0);
  EXPECT_NEAR(track.heading_rad, std::atan2(velocity.y(), velocity.x()), 0.15);
  EXPECT_NEAR(track.length_m, 4.5, 0.6);
  EXPECT_EQ(track.movement, MovementState::kMoving);
  EXPECT_EQ(track.object_class, ObjectClass::kCar);
  EXPECT_NEAR(track.age_s, 59 * 0.05, 1e-3);
  EXPECT_GT(track.existence_probability, 0.95F);
}

TEST_F(TrackerTest, KnowsWhereAPersonGoesWhoCrossesTheLineOfSight) {
  // Hardly a range rate: the velocity shows by the place only, which is as sure as a person is small.
  const auto walk = [&](double rcs_dbsm) {
    Tracker tracker(two_radars(), RulesConfig{});
    const Eigen::Vector2d v(0.0, 1.3);
    for (int k = 0; k < 40; ++k) {
      scene_.begin(now_ + k * 50 * kMillisecond);
      scene_.add(Eigen::Vector2d(15.0, -4.0) + 0.05 * k * v, v);
      scene_.scan->fields |= scan_field::kRcs;
      scene_.scan->rcs_dbsm[0] = static_cast<float>(rcs_dbsm);
      tracker.step(*scene_.scan);
    }
    tracker.write(*list_);
    return list_->tracks[0];
  };
  const Track person = walk(-6.0), car = walk(10.0);
  EXPECT_LT(person.length_m, 1.5F);
  EXPECT_NEAR(person.velocity_over_ground_mps[1], 1.3, 0.3);
  EXPECT_NEAR(person.position_vehicle_m[1], -1.465, 0.3);
  const std::size_t across = 3 * kTrackStateSize + 3;
  EXPECT_LT(person.covariance[across], 0.5F * car.covariance[across]);
}

TEST_F(TrackerTest, PeopleWhoComeTogetherAndWalkAbreastKeepTheirNames) {
  // In the end nearer to each other than a cluster's radius.
  const auto place = [](int k, double sign) {
    return Eigen::Vector2d(12.0 + 0.05 * k, sign * std::max(0.8, 2.5 - 0.03 * k));
  };
  std::map<double, std::set<std::uint32_t>> names;
  for (int k = 0; k < 120; ++k) {
    scene_.begin(now_ + k * 50 * kMillisecond);
    for (const double sign : {-1.0, 1.0}) scene_.add(place(k, sign), (place(k + 1, sign) - place(k, sign)) / 0.05);
    scene_.scan->fields |= scan_field::kRcs;
    scene_.scan->rcs_dbsm[0] = scene_.scan->rcs_dbsm[1] = -6.0F;
    tracker_.step(*scene_.scan);
    if (k < 20) continue;
    const TrackList& tracks = list();
    for (const double sign : {-1.0, 1.0}) {
      for (std::size_t t = 0; t < tracks.number_of_confirmed_tracks; ++t) {
        const Eigen::Vector2d at(tracks.tracks[t].position_vehicle_m[0], tracks.tracks[t].position_vehicle_m[1]);
        if ((at - place(k, sign)).norm() < 0.5) names[sign].insert(tracks.tracks[t].tracking_id);
      }
    }
  }
  EXPECT_EQ(list().number_of_confirmed_tracks, 2u);
  EXPECT_EQ(names[-1.0].size(), 1u);
  EXPECT_EQ(names[1.0].size(), 1u);
  EXPECT_NE(names[-1.0], names[1.0]);
}

TEST_F(TrackerTest, WhatAVehicleHidesIsNotMissed) {
  // A car drives in front of another one, which is not seen any more; nor is a third, which nothing hides.
  const Eigen::Vector2d v(8.0, 0.0);
  for (int k = 0; k < 20; ++k) {
    scene_.begin(now_);
    const Eigen::Vector2d moved = 0.05 * k * v;
    scene_.add(Eigen::Vector2d(15.0, 0.0) + moved, v);
    if (k < 12) scene_.add(Eigen::Vector2d(40.0, 0.3) + moved, v);
    if (k < 12) scene_.add(Eigen::Vector2d(40.0, 15.0) + moved, v);
    tracker_.step(*scene_.scan);
    now_ += 50 * kMillisecond;
  }
  bool hidden = false;
  const TrackList& tracks = list();
  for (std::size_t t = 0; t < tracks.number_of_confirmed_tracks; ++t) {
    const Track& track = tracks.tracks[t];
    if (track.position_vehicle_m[0] < 35.0F) continue;
    if (track.position_vehicle_m[1] < 5.0F) hidden = track.existence_probability > 0.9F;
    if (track.position_vehicle_m[1] > 10.0F) {
      EXPECT_LT(track.existence_probability, 0.5F);
    }
  }
  EXPECT_TRUE(hidden);
}

TEST_F(TrackerTest, OutputHasNothingOfTheStaleChunk) {
  for (int i = 0; i < 6; ++i) step({30.0 + 0.4 * i, 0.0}, {8.0, 0.0});
  const Track& t = list().tracks[0];
  EXPECT_EQ(list().dropped_tracks, 0u);
  EXPECT_EQ(list().flags, 0u);
  EXPECT_EQ(list().tracker_flags, 0u);
  EXPECT_EQ(t.flags, 0u);
  EXPECT_TRUE(std::isfinite(t.time_since_update_s) && std::isfinite(t.mirror_probability) &&
              std::isfinite(t.position_vehicle_m[2]));
  float sum = 0.0F;
  for (const float probability : t.class_probability) sum += probability;
  EXPECT_EQ(sum, 1.0F);
  EXPECT_EQ(t.class_probability[static_cast<std::size_t>(t.object_class)], 1.0F);
  const Eigen::Map<const Eigen::Matrix<float, kTrackStateSize, kTrackStateSize>> covariance(t.covariance.data());
  EXPECT_TRUE(covariance.allFinite());
  EXPECT_GT(covariance.diagonal().minCoeff(), 0.0F);
}

TEST_F(TrackerTest, IsDeletedAfterEightMissesOfTenAndHalfASecond) {
  for (int i = 0; i < 20; ++i) step({30.0 + 0.4 * i, 0.0}, {8.0, 0.0});
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  for (int i = 0; i < 9; ++i) step({}, {}, false);
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u) << "eight misses, but what hides it may be gone soon";
  EXPECT_EQ(list().tracks[0].update, TrackUpdate::kPredicted);
  EXPECT_NEAR(list().tracks[0].time_since_update_s, 0.45, 1e-3);
  step({}, {}, false);
  EXPECT_EQ(list().number_of_tracks, 0u);
}

TEST_F(TrackerTest, ScansThatCannotSeeItDoNotCount) {
  for (int i = 0; i < 20; ++i) step({30.0 + 0.4 * i, -10.0}, {8.0, 0.0});
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  // Radar 2 looks to the left: it says nothing about what is ahead on the right. Only the second of coasting ends it.
  for (int i = 0; i < 60; ++i) {
    scene_.begin(now_, 2);
    tracker_.step(*scene_.scan);
    now_ += 10 * kMillisecond;
  }
  EXPECT_EQ(list().number_of_confirmed_tracks, 1u);
  for (int i = 0; i < 60; ++i) {
    scene_.begin(now_, 2);
    tracker_.step(*scene_.scan);
    now_ += 10 * kMillisecond;
  }
  EXPECT_EQ(list().number_of_tracks, 0u);
}

TEST_F(TrackerTest, RadarsOutOfStepShareOneTrack) {
  // Ahead on the left both see it; their scans are 17 ms apart and the second ones come late by 5 ms of order.
  const Eigen::Vector2d start(15.0, 9.0), velocity(5.0, 4.0);
  for (int i = 0; i < 40; ++i) {
    for (const auto& [radar, offset_ms] : {std::pair{1u, 17}, std::pair{2u, 12}}) {
      const double t = 0.05 * i + 1e-3 * offset_ms;
      scene_.begin(now_ + i * 50 * kMillisecond + offset_ms * kMillisecond, radar);
      scene_.add(start + t * velocity, velocity);
      const StepResult result = tracker_.step(*scene_.scan);
      EXPECT_EQ(result.out_of_order, radar == 2u);
      EXPECT_FALSE(result.restarted);
    }
  }
  ASSERT_EQ(list().number_of_tracks, 1u);
  EXPECT_NEAR(list().tracks[0].velocity_over_ground_mps[0], 5.0, 0.7);
  EXPECT_NEAR(list().tracks[0].velocity_over_ground_mps[1], 4.0, 0.7);
}

TEST_F(TrackerTest, CrossingObjectsKeepTheirNames) {
  std::uint32_t a = 0, b = 0;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.05 * i;
    scene_.begin(now_);
    scene_.add({20.0 + 8.0 * t, 12.0 - 5.0 * t}, {8.0, -5.0});
    scene_.add({60.0 - 9.0 * t, -3.0}, {-9.0, 0.0});
    tracker_.step(*scene_.scan);
    now_ += 50 * kMillisecond;
    if (i < 20) continue;
    ASSERT_EQ(list().number_of_confirmed_tracks, 2u) << i;
    for (const Track& track : {list_->tracks[0], list_->tracks[1]}) {
      std::uint32_t& name = track.velocity_over_ground_mps[0] > 0.0F ? a : b;
      if (name == 0) name = track.tracking_id;
      EXPECT_EQ(track.tracking_id, name) << i;
    }
  }
  EXPECT_NE(a, b);
}

TEST_F(TrackerTest, AJumpOfTheClockDropsEverything) {
  for (int i = 0; i < 10; ++i) step({30.0 + 0.4 * i, 0.0}, {8.0, 0.0});
  const std::uint32_t name = list().tracks[0].tracking_id;
  now_ -= 60'000 * kMillisecond;
  scene_.begin(now_);
  EXPECT_TRUE(tracker_.step(*scene_.scan).restarted);
  EXPECT_EQ(list().number_of_tracks, 0u);
  for (int i = 0; i < 10; ++i) step({30.0 + 0.4 * i, 0.0}, {8.0, 0.0});
  EXPECT_GT(list().tracks[0].tracking_id, name) << "a name is never used again";
}

TEST_F(TrackerTest, AClockThatIsSetBackALittleDoesNotFreezeIt) {
  for (int i = 0; i < 10; ++i) step({30.0 + 0.4 * i, 0.0}, {8.0, 0.0});
  now_ -= 1900 * kMillisecond;
  scene_.begin(now_);
  EXPECT_TRUE(tracker_.step(*scene_.scan).restarted);
  for (int i = 10; i < 20; ++i) step({30.0 + 0.4 * i, 0.0}, {8.0, 0.0});
  ASSERT_EQ(list().number_of_confirmed_tracks, 1u);
  EXPECT_NEAR(list().tracks[0].velocity_over_ground_mps[0], 8.0, 0.5);
}

TEST_F(TrackerTest, MoreObjectsThanRoomAreCounted) {
  for (int round = 0; round < 8; ++round) {
    scene_.begin(now_);
    // Far apart, and more each time than a scan's clusters.
    for (int i = 0; i < 100; ++i) {
      scene_.add({8.0 + 8.0 * (i % 12), -60.0 + 13.0 * (i / 12) + (round % 2 == 0 ? 0.0 : 6.5)},
                 {round % 2 == 0 ? 20.0 : -20.0, 0.0});
    }
    const StepResult result = tracker_.step(*scene_.scan);
    EXPECT_LE(list().number_of_tracks, kMaxTracks);
    EXPECT_EQ(result.dropped_objects, list().dropped_tracks);
    if (list().dropped_tracks > 0) return;
    now_ += 5 * kMillisecond;
  }
  ADD_FAILURE() << "never full";
}

TEST_F(TrackerTest, TheFlagsOfTheScanGoOn) {
  scene_.begin(now_);
  scene_.scan->flags = pipeline_flag::kNoTracks | pipeline_flag::kNoAlignment;
  tracker_.step(*scene_.scan);
  EXPECT_EQ(list().flags, pipeline_flag::kNoTracks | pipeline_flag::kNoAlignment);
}

TEST_F(TrackerTest, AllocatesNothing) {
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int i = 0; i < 50; ++i) {
      scene_.begin(now_, 1u + static_cast<unsigned>(i) % 2u);
      for (int k = 0; k < 120; ++k) scene_.add({10.0 + k * 0.7, -30.0 + (k * 37) % 60}, {10.0, 1.0});
      tracker_.step(*scene_.scan);
      tracker_.write(*list_);
      now_ += 25 * kMillisecond;
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::tracking
