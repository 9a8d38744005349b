// What tracks may not do, whatever the detections say: ghosts draw them through each other and the own vehicle.
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracker/core/duplicates.hpp"
#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

/// Radars on all four corners.
VehicleConfig four_corners() {
  VehicleConfig vehicle;
  std::uint32_t id = 0;
  for (const double x : {3.6, -0.8}) {
    for (const double y : {0.75, -0.75}) {
      RadarConfig radar;
      radar.id = ++id;
      radar.mounting_pose = {{x, y, 0.5}, 0.0, 0.0, 0.0};
      radar.field_of_view.azimuth_min_rad = -M_PI;
      radar.field_of_view.azimuth_max_rad = M_PI;
      vehicle.radars.push_back(radar);
    }
  }
  return vehicle;
}

/// How many of two tracks of cars are left, the second one that far ahead of the first and to its left.
std::size_t left_of_two(double ahead_m, double left_m, bool confirmed) {
  std::vector<TrackedObject> tracks(2);
  for (TrackedObject& track : tracks) {
    track.confirmed = true;
    track.age_s = 1.0;
    track.state.mean << -17.0, 0.0, 15.0, 0.0, 0.0, 0.0;
    track.state.covariance.setIdentity();
  }
  tracks[1].state.mean.head<2>() += Eigen::Vector2d(ahead_m, left_m);
  tracks[1].state.mean(2) += 2.5;
  tracks[1].confirmed = confirmed;
  remove_duplicates(tracks, {-0.8, 0.0}, RulesConfig{});
  return tracks.size();
}

TEST(Duplicates, NeighboursDrawnTogetherStayTwoButNothingIsTwiceInItsPlace) {
  EXPECT_EQ(left_of_two(-2.4, 1.8, true), 2U) << "overtakes in the next lane, whose place is not known well yet";
  EXPECT_EQ(left_of_two(-2.4, 1.8, false), 1U) << "another part of the same, as far as is known";
  EXPECT_EQ(left_of_two(-1.0, 0.5, true), 1U);
  EXPECT_EQ(left_of_two(-3.0, 0.5, true), 1U) << "its other end";
}

/// How many are left of two confirmed vehicles, 4.5 m long, one 3 m behind the other at 20 m/s, seen from beside.
std::size_t left_in_file(double across_mps) {
  std::vector<TrackedObject> tracks(2);
  for (TrackedObject& track : tracks) {
    track.confirmed = true;
    track.age_s = 1.0;
    track.state.mean << 20.0, 6.0, 20.0, 0.0, 0.0, 0.0;
  }
  tracks[1].state.mean(0) += 7.5;
  tracks[1].state.mean(3) = across_mps;
  remove_duplicates(tracks, {0.0, 0.0}, RulesConfig{});
  return tracks.size();
}

TEST(Duplicates, TheEndsOfALongVehicleMoveAlike) {
  EXPECT_EQ(left_in_file(0.5), 1U);
  EXPECT_EQ(left_in_file(3.0), 2U) << "seems to come over from the next lane";
}

TEST(Duplicates, WhoStandsBesideAVehicleIsNoPartOfItButAWheelIs) {
  const auto left_of = [](double beside_m) {
    std::vector<TrackedObject> tracks(2);
    for (TrackedObject& track : tracks) {
      track.confirmed = true;
      track.age_s = 1.0;
      track.state.mean << 20.0, 6.0, 4.0, 0.0, 0.0, 0.0;
    }
    tracks[1].extent.is_small = true;
    tracks[1].extent.length_m = 1.2;
    tracks[1].extent.width_m = 0.7;
    tracks[1].state.mean(1) -= 0.5 * Extent::kCarWidth_m + beside_m;
    remove_duplicates(tracks, {0.0, 0.0}, RulesConfig{});
    return tracks.size();
  };
  EXPECT_EQ(left_of(0.3), 1U) << "a wheel";
  EXPECT_EQ(left_of(0.8), 2U) << "a person";
}

TEST(Duplicates, ABoxDrawnToAPersonWhomItPassesDoesNotSwallowThem) {
  const auto left_of = [](double deep_m, double age_s) {
    std::vector<TrackedObject> tracks(2);
    for (TrackedObject& track : tracks) {
      track.confirmed = true;
      track.age_s = age_s;
      track.state.mean << 14.0, 0.0, 3.5, 0.0, 0.0, 0.0;
    }
    tracks[1].extent.is_small = true;
    tracks[1].extent.length_m = 1.2;
    tracks[1].extent.width_m = 0.7;
    tracks[1].state.mean(1) -= 0.5 * Extent::kCarWidth_m - deep_m;
    tracks[1].state.mean(2) = -1.2;
    remove_duplicates(tracks, {0.0, 0.0}, RulesConfig{});
    return tracks.size();
  };
  EXPECT_EQ(left_of(0.2, 5.0), 2U);
  EXPECT_EQ(left_of(0.6, 5.0), 1U) << "a wheel";
  EXPECT_EQ(left_of(0.2, 1.0), 1U) << "not tracked for long: a wheel";
}

TEST(Extent, TellsTheShortestWayOffTheOwnVehicle) {
  const Extent truck{.heading_rad = 0.0, .length_m = 16.0, .width_m = 2.5};
  const Eigen::Vector2d middle(1.4, 0.0), half(2.2, 0.75);
  EXPECT_EQ(truck.way_off({2.0, -3.0}, middle, half), Eigen::Vector2d(0.0, 0.0));
  EXPECT_LT((truck.way_off({2.0, -1.5}, middle, half) - Eigen::Vector2d(0.0, -0.5)).norm(), 1e-12);
  EXPECT_LT((truck.way_off({11.4, -0.2}, middle, half) - Eigen::Vector2d(0.2, 0.0)).norm(), 1e-12) << "ahead";
  const Extent crossing{.heading_rad = 0.5 * M_PI, .length_m = 16.0, .width_m = 2.5};
  EXPECT_LT((crossing.way_off({4.6, 3.0}, middle, half) - Eigen::Vector2d(0.25, 0.0)).norm(), 1e-12);
}

TEST(TrackerOwnVehicle, NothingIsTrackedThroughIt) {
  // A car drives beside; ghosts on the own side of it that the filter does not tell draw its track over.
  Tracker tracker(four_corners(), RulesConfig{});
  Scene scene;
  TrackList list;
  std::int64_t now = 1'000'000 * kMillisecond;
  for (int i = 0; i < 140; ++i) {
    scene.begin(now);
    scene.scan->geometry.ego_speed_mps = 15.0F;
    const double y = -2.9 + 0.03 * std::clamp(i - 40, 0, 83);
    for (const double part : {-1.0, 0.0, 1.0}) scene.add({1.0 + part, y}, {15.0, 0.0});
    tracker.step(*scene.scan);
    now += 50 * kMillisecond;
    tracker.write(list);
    for (std::size_t k = 0; k < list.number_of_tracks; ++k) {
      const Track& t = list.tracks[k];
      const Extent box{.heading_rad = t.heading_rad, .length_m = t.length_m, .width_m = t.width_m};
      const Eigen::Vector2d centre(t.position_vehicle_m[0], t.position_vehicle_m[1]);
      // A track that begins in this scan is moved in the next one.
      if (t.age_s < 0.01F) continue;
      EXPECT_LT(box.way_off(centre, {1.4, 0.0}, {2.2, 0.75}).norm(), 0.1) << "after " << 0.05 * i << " s";
    }
  }
  EXPECT_GE(list.number_of_confirmed_tracks, 1u);
}

TEST(TrackerDuplicates, TwoThatWereLongTrackedAtTheirOwnSpeedsStayTwo) {
  // One overtakes the other after three seconds, so closely, by what is seen of both, that it passes through its box.
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  TrackList list;
  std::int64_t now = 1'000'000 * kMillisecond;
  std::set<std::uint32_t> ids;
  for (int i = 0; i < 85; ++i) {
    scene.begin(now);
    const double t = 0.05 * i, slow = 36.0 + 5.0 * t, fast = 15.0 + 12.0 * t;
    for (const double part : {-0.6, 0.0, 0.6}) {
      scene.add({slow, part}, {5.0, 0.0});
      scene.add({fast, 0.3 + part}, {12.0, 0.0});
    }
    tracker.step(*scene.scan);
    now += 50 * kMillisecond;
    tracker.write(list);
    for (std::size_t k = 0; k < list.number_of_confirmed_tracks; ++k) ids.insert(list.tracks[k].tracking_id);
    if (i > 20) {
      EXPECT_EQ(list.number_of_confirmed_tracks, 2u) << "after " << t << " s";
    }
  }
  EXPECT_EQ(ids.size(), 2u);
}

TEST(TrackerDuplicates, LimbsThatWereLongTrackedAtTheirOwnSpeedsAreOne) {
  // As small and weak as limbs are, and at speeds of their own; in the end they are in one place.
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  TrackList list;
  for (int i = 0; i < 55; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    scene.scan->fields |= scan_field::kRcs;
    scene.scan->rcs_dbsm[0] = scene.scan->rcs_dbsm[1] = -8.0F;
    const double t = 0.05 * i;
    scene.add({20.0 + 2.2 * t, 0.0}, {2.2, 0.0});
    scene.add({32.0 - 2.2 * t, 0.0}, {-2.2, 0.0});
    tracker.step(*scene.scan);
    tracker.write(list);
    if (i == 42) {
      ASSERT_EQ(list.number_of_confirmed_tracks, 2u) << "apart, tracked for over two seconds";
    }
  }
  EXPECT_EQ(list.number_of_confirmed_tracks, 1u) << "nobody walks through another";
}

/// From the first second on both are tracked, each by one track to the end. `add(scene, t_s)` says what is detected of
/// them, `check(track, t_s)` looks at their tracks.
template <typename Add, typename Check>
void expect_two_that_stay(int scans, const Add& add, const Check& check) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  TrackList list;
  std::set<std::uint32_t> ids;
  for (int i = 0; i < scans; ++i) {
    const double t_s = 0.05 * i;
    scene.begin((1000 + 50 * i) * kMillisecond);
    add(scene, t_s);
    tracker.step(*scene.scan);
    tracker.write(list);
    if (i < 20) continue;
    ASSERT_EQ(list.number_of_confirmed_tracks, 2u) << "after " << t_s << " s";
    for (const Track& track : {list.tracks[0], list.tracks[1]}) {
      ids.insert(track.tracking_id);
      check(track, t_s);
    }
  }
  EXPECT_EQ(ids.size(), 2u);
}

void check_nothing(const Track& /*track*/, double /*t_s*/) {}

TEST(TrackerDuplicates, AVehicleThatIsOvertakenInTheNextLaneStaysATrack) {
  // Seen from ahead, their nearest reflections are nearer than a cluster's radius, and 2.5 m/s tells no clusters apart.
  const auto add = [](Scene& scene, double t) {
    const double fast = 54.0 - 7.5 * t, slow = 45.0 - 5.0 * t;
    for (const double part : {-0.8, 0.0, 0.8}) {
      scene.add({slow, part}, {-5.0, 0.0});
      scene.add({fast, 3.4 + part}, {-7.5, 0.0});
    }
  };
  expect_two_that_stay(100, add, check_nothing);
}

TEST(TrackerDuplicates, APersonWhomACarPassesNearbyStaysATrack) {
  // The car drives away, the person comes towards the radar, a step beside the car's box.
  const auto add = [](Scene& scene, double t) {
    scene.scan->fields |= scan_field::kRcs;
    scene.scan->rcs_dbsm[0] = scene.scan->rcs_dbsm[1] = 12.0F;
    scene.scan->rcs_dbsm[2] = -6.0F;
    scene.add({15.0 + 3.3 * t, -0.7}, {3.3, 0.0});
    scene.add({15.0 + 3.3 * t, 0.7}, {3.3, 0.0});
    scene.add({32.0 - 1.2 * t, -1.5}, {-1.2, 0.0});
  };
  expect_two_that_stay(100, add, check_nothing);
}

TEST(TrackerDuplicates, PeopleWhoPassEachOtherAtArmsLengthStayTwo) {
  // One behind the other, seen from the radar, when they meet: only places tell them apart.
  const auto way = [](double t) { return 1.4 * t - 4.2; };
  const auto add = [&](Scene& scene, double t) {
    scene.scan->fields |= scan_field::kRcs;
    for (std::size_t k = 0; k < 6; ++k) scene.scan->rcs_dbsm[k] = -8.0F;
    for (const double part : {-0.1, 0.0, 0.1}) {
      scene.add({9.0 + part, way(t)}, {0.0, 1.4});
      scene.add({9.8 + part, -way(t)}, {0.0, -1.4});
    }
  };
  const auto check = [&](const Track& track, double t) {
    const bool is_near = track.position_vehicle_m[0] < 9.5F;
    EXPECT_NEAR(track.position_vehicle_m[1], is_near ? way(t) : -way(t), 0.4) << "after " << t << " s";
  };
  expect_two_that_stay(120, add, check);
}

}  // namespace
}  // namespace boresight::tracking
