#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/tracker/scene.hpp"

// When a track begins, and when it is confirmed.
namespace boresight::tracking {
namespace {

/// Scans until the object is confirmed, whose detections may be ghosts with that probability; 0: never.
int scans_to_confirm(double ghost_probability) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  for (int i = 0; i < 40; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    scene.add({30.0 + 0.4 * i, 0.0}, {8.0, 0.0}, Provenance::kMoving, ghost_probability);
    tracker.step(*scene.scan);
    tracker.write(*list);
    if (list->number_of_confirmed_tracks > 0) return i + 1;
    EXPECT_EQ(list->number_of_tracks, ghost_probability > 0.8 ? 0u : 1u);
  }
  return 0;
}

TEST(TrackerBirth, NeedsEvidenceThatIsReal) {
  EXPECT_EQ(scans_to_confirm(0.0), 4);
  EXPECT_EQ(scans_to_confirm(0.05), 4);
  EXPECT_EQ(scans_to_confirm(0.3), 5);
  EXPECT_EQ(scans_to_confirm(0.5), 6);
  EXPECT_EQ(scans_to_confirm(0.6), 0) << "too doubtful for ever";
  EXPECT_EQ(scans_to_confirm(0.9), 0) << "not even tentative";
}

/// Seconds from the first detection until an object that goes away is confirmed, whose detections are all as strong.
double seconds_to_confirm(double speed_mps, float rcs_dbsm) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  for (int i = 0; i < 100; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    scene.scan->fields |= scan_field::kRcs;
    scene.add({20.0 + 0.05 * speed_mps * i, 0.0}, {speed_mps, 0.0});
    scene.scan->rcs_dbsm[0] = rcs_dbsm;
    tracker.step(*scene.scan);
    tracker.write(*list);
    if (list->number_of_confirmed_tracks > 0) return 0.05 * i;
  }
  return 1e9;
}

TEST(TrackerBirth, WhatIsWeakerThanAnythingAsFastHasToWait) {
  EXPECT_NEAR(seconds_to_confirm(15.0, 10.0F), 0.15, 1e-6) << "a car";
  EXPECT_NEAR(seconds_to_confirm(15.0, -14.0F), 4.0, 1e-6) << "a car's image";
  EXPECT_NEAR(seconds_to_confirm(2.0, -10.0F), 0.15, 1e-6) << "a person";
  EXPECT_NEAR(seconds_to_confirm(2.0, -12.0F), 4.0, 1e-6) << "an image";
  EXPECT_NEAR(seconds_to_confirm(7.0, -5.0F), 0.15, 1e-6) << "a cycle";
  EXPECT_NEAR(seconds_to_confirm(7.0, -11.0F), 4.0, 1e-6) << "nobody runs that fast";
  EXPECT_NEAR(seconds_to_confirm(15.0, std::numeric_limits<float>::quiet_NaN()), 0.15, 1e-6) << "strength not measured";
}

TEST(TrackerBirth, WhoIsTakenForAPersonAndOutrunsThemHasToWaitAfterAll) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  double x = 20.0, confirmed_s = 0.0;
  bool was_a_person = false;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.05 * i, speed_mps = std::min(7.0, 2.0 + 3.0 * t);
    scene.begin((1000 + 50 * i) * kMillisecond);
    scene.scan->fields |= scan_field::kRcs;
    scene.add({x += 0.05 * speed_mps, 0.0}, {speed_mps, 0.0});
    scene.scan->rcs_dbsm[0] = -10.0F;
    tracker.step(*scene.scan);
    tracker.write(*list);
    was_a_person = was_a_person || (t < 0.4 && list->number_of_confirmed_tracks == 1);
    if (t > 1.0 && confirmed_s == 0.0 && list->number_of_confirmed_tracks == 1) confirmed_s = t;
  }
  EXPECT_TRUE(was_a_person);
  EXPECT_NEAR(confirmed_s, 4.0, 0.06);
}

/// Beside a car of 10 dBsm: seconds until something that comes with it is confirmed, over there, with the velocity.
/// `truck`: one drives behind the car in the next lane, at its speed.
double seconds_beside_a_car(const Eigen::Vector2d& beside_m, const Eigen::Vector2d& velocity_mps, float rcs_dbsm,
                            bool truck = false) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  for (int i = 0; i < 60; ++i) {
    const double t = 0.05 * i;
    scene.begin((1000 + 50 * i) * kMillisecond);
    scene.scan->fields |= scan_field::kRcs;
    scene.add({40.0 + 15.0 * t, 0.0}, {15.0, 0.0});
    scene.scan->rcs_dbsm[0] = 10.0F;
    scene.add(Eigen::Vector2d(40.0, 0.0) + beside_m + t * velocity_mps, velocity_mps);
    scene.scan->rcs_dbsm[1] = rcs_dbsm;
    if (truck) {
      // Its flank, 2.4 m beside the car's middle.
      for (const double x : {20.0, 23.0, 26.0}) {
        scene.add({x + 15.0 * t, 2.4}, {15.0, 0.0});
        scene.scan->rcs_dbsm[scene.scan->number_of_valid_detections - 1] = 20.0F;
      }
    }
    tracker.step(*scene.scan);
    tracker.write(*list);
    if (list->number_of_confirmed_tracks > (truck ? 2u : 1u)) return t;
  }
  return 1e9;
}

TEST(TrackerBirth, WhatMayBeAnotherOnesImageHasToWait) {
  const Eigen::Vector2d along(15.0, 0.0);
  EXPECT_NEAR(seconds_beside_a_car({0.5, 6.0}, along, 0.0F), 1.0, 1e-6) << "an image, or a weak car in the next lane";
  EXPECT_NEAR(seconds_beside_a_car({0.5, 4.8}, along, 0.0F, true), 2.0, 1e-6) << "an image in a truck's flank";
  EXPECT_NEAR(seconds_beside_a_car({0.5, -4.8}, along, 0.0F, true), 1.0, 1e-6) << "not where that would show it";
  EXPECT_NEAR(seconds_beside_a_car({0.5, 6.0}, along, 9.0F), 0.15, 1e-6) << "as strong as the other one";
  EXPECT_NEAR(seconds_beside_a_car({0.5, 6.0}, {12.0, 0.0}, 0.0F), 0.15, 1e-6) << "moves otherwise";
  EXPECT_NEAR(seconds_beside_a_car({-6.0, 6.0}, along, 0.0F), 0.15, 1e-6) << "nothing mirrors to where it is nearer";
  EXPECT_NEAR(seconds_beside_a_car({14.0, 6.0}, along, 0.0F), 0.15, 1e-6) << "a detour that no lane makes";
  EXPECT_NEAR(seconds_beside_a_car({0.5, 6.0}, along, std::numeric_limits<float>::quiet_NaN()), 0.15, 1e-6)
      << "strength not measured";
}

/// Velocity with which a car begins that is first seen there, at that velocity, by a vehicle that drives at 20 m/s on a
/// bend of that curvature.
Eigen::Vector2d velocity_at_birth(const Eigen::Vector2d& at_m, const Eigen::Vector2d& velocity_mps,
                                  double curvature_per_m = 0.0) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  scene.begin(1000 * kMillisecond);
  scene.scan->geometry.ego_speed_mps = 20.0F;
  scene.scan->geometry.ego_yaw_rate_radps = static_cast<float>(20.0 * curvature_per_m);
  scene.add(at_m, velocity_mps);
  tracker.step(*scene.scan);
  const auto list = std::make_unique<TrackList>();
  tracker.write(*list);
  EXPECT_EQ(list->number_of_tracks, 1u);
  const auto& v = list->tracks[0].velocity_over_ground_mps;
  return {v[0], v[1]};
}

TEST(TrackerBirth, FarAwayOnTheOwnRoadItDrivesAlongIt) {
  const Eigen::Vector2d along = velocity_at_birth({80.0, 7.0}, {2.0, 0.0});
  EXPECT_NEAR(along.x(), 2.0, 1e-3);
  EXPECT_NEAR(along.y(), 0.0, 1e-3);
  const Eigen::Vector2d oncoming = velocity_at_birth({80.0, 3.6}, {-15.0, 0.0});
  EXPECT_NEAR(oncoming.x(), -15.0, 1e-2);
  EXPECT_NEAR(oncoming.y(), 0.0, 1e-3);
  // On a circle of 500 m to the left the road has turned by 0.16 rad after 80 m, and is 6.4 m aside.
  const Eigen::Vector2d turned = velocity_at_birth({80.0, 6.4}, {2.0, 0.32}, 1.0 / 500.0);
  EXPECT_NEAR(std::atan2(turned.y(), turned.x()), 0.16, 1e-3);
}

TEST(TrackerBirth, ElsewhereOnlyTheRangeRateIsKnown) {
  for (const Eigen::Vector2d& at_m : {Eigen::Vector2d(20.0, 7.0), {80.0, 12.0}}) {
    const Eigen::Vector2d sight = at_m - Eigen::Vector2d(3.6, 0.0), v = velocity_at_birth(at_m, {2.0, 0.0});
    EXPECT_NEAR(std::atan2(v.y(), v.x()), std::atan2(sight.y(), sight.x()), 1e-5) << at_m.transpose();
  }
}

TEST(TrackerBirth, WhatCrossesFarAheadIsFollowedAllTheSame) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  for (int i = 0; i < 60; ++i) {
    const double t = 0.05 * i;
    const Eigen::Vector2d velocity(2.0, 8.0), at = Eigen::Vector2d(60.0, -7.0) + t * velocity;
    scene.begin((1000 + 50 * i) * kMillisecond);
    scene.add(at, velocity);
    tracker.step(*scene.scan);
    tracker.write(*list);
    if (t < 0.3) continue;
    ASSERT_EQ(list->number_of_confirmed_tracks, 1u) << t;
    EXPECT_NEAR(list->tracks[0].position_vehicle_m[1], at.y(), 2.0) << t;
  }
  EXPECT_NEAR(list->tracks[0].velocity_over_ground_mps[1], 8.0, 2.0);
}

TEST(TrackerBirth, AnImageThatIsFoundBeforeItsObjectWaitsAfterAll) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  const Eigen::Vector2d along(15.0, 0.0);
  bool was_confirmed = false;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.05 * i;
    scene.begin((1000 + 50 * i) * kMillisecond);
    scene.scan->fields |= scan_field::kRcs;
    const auto add = [&](double x_m, double y_m, float rcs_dbsm) {
      scene.add({x_m + 15.0 * t, y_m}, along);
      scene.scan->rcs_dbsm[scene.scan->number_of_valid_detections - 1] = rcs_dbsm;
    };
    add(40.5, 4.8, 0.0F);
    if (i >= 6) add(40.0, 0.0, 10.0F);
    for (const double x : {20.0, 23.0, 26.0}) add(x, 2.4, 20.0F);
    tracker.step(*scene.scan);
    tracker.write(*list);
    was_confirmed = was_confirmed || (i < 6 && list->number_of_confirmed_tracks == 2);
    if (t > 0.6 && t < 1.9) {
      EXPECT_EQ(list->number_of_confirmed_tracks, 2u) << "the truck and the car, at " << t;
    }
  }
  EXPECT_TRUE(was_confirmed);
}

TEST(TrackerBirth, WhoComesBesideAPersonIsNoPartOfThem) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  for (int i = 0; i < 40; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    scene.scan->fields |= scan_field::kRcs;
    const double x = 15.0 + 0.05 * 1.2 * i;
    scene.add({x, 0.0}, {1.2, 0.0});
    if (i >= 20) scene.add({x, 1.6}, {1.2, 0.0});
    for (std::size_t k = 0; k < 2; ++k) scene.scan->rcs_dbsm[k] = -5.0F;
    tracker.step(*scene.scan);
    tracker.write(*list);
    EXPECT_LE(list->number_of_confirmed_tracks, i < 20 ? 1u : 2u);
  }
  EXPECT_EQ(list->number_of_confirmed_tracks, 2u);
}

TEST(TrackerBirth, SeveralRadarsAtOneInstantAreOneLook) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  for (int i = 0; i < 8; ++i) {
    scene.begin((1000 + i) * kMillisecond, 1u + static_cast<unsigned>(i) % 2u);
    scene.add({15.0, 9.0}, {5.0, 4.0});
    tracker.step(*scene.scan);
    tracker.write(*list);
    EXPECT_EQ(list->number_of_confirmed_tracks, 0u);
  }
  EXPECT_EQ(list->number_of_tracks, 1u);
}

}  // namespace
}  // namespace boresight::tracking
