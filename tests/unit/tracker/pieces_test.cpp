// Long vehicles of which pieces are seen: one track, and drivers who follow closely: two.
#include "services/tracker/core/pieces.hpp"

#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

const Eigen::Vector2d kFragmentSensor_m(3.6, 0.0);
constexpr double kScan_s = 0.05, kCreeps_mps = 1.2;

TrackedObject vehicle(std::uint32_t id, double x_m, double y_m, double age_s) {
  TrackedObject track;
  track.id = id;
  track.confirmed = true;
  track.age_s = age_s;
  track.detections = 1;
  track.extent.length_m = 5.5;
  track.state.mean.head<2>() << x_m, y_m;
  track.state.mean(2) = kCreeps_mps;
  return track;
}

/// As long as that; the second one drives away from the first one by `away_mps`.
void drive(std::vector<TrackedObject>& tracks, double seconds, double away_mps) {
  for (double t = 0.0; t < seconds; t += kScan_s) {
    for (TrackedObject& track : tracks) track.age_s += kScan_s;
    tracks[1].state.mean.x() += kScan_s * away_mps;
    watch_pieces(tracks, kFragmentSensor_m);
  }
}

TEST(Pieces, AreOfOneVehicleThatKeepTheirDistanceForThreeSeconds) {
  std::vector<TrackedObject> tracks{vehicle(1, 50.0, -3.0, 5.0), vehicle(2, 58.0, -3.0, 4.0)};
  drive(tracks, 2.5, 0.0);
  EXPECT_FALSE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m)) << "not known yet";
  EXPECT_NEAR(piece_wait_s(tracks[1]), 7.0, 2.0 * kScan_s);
  EXPECT_EQ(piece_wait_s(tracks[0]), 0.0) << "the older one is the whole";
  drive(tracks, 1.0, 0.0);
  EXPECT_TRUE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m));
  EXPECT_FALSE(is_piece_of(tracks[0], tracks[1], kFragmentSensor_m));
}

TEST(Pieces, AreNoneThatMoveOnTheirOwn) {
  std::vector<TrackedObject> tracks{vehicle(1, 50.0, -3.0, 5.0), vehicle(2, 58.0, -3.0, 4.0)};
  drive(tracks, 4.5, -0.3);  // comes nearer
  EXPECT_FALSE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m));
  EXPECT_EQ(piece_wait_s(tracks[1]), 0.0) << "nor is it kept waiting";
}

TEST(Pieces, OfWhichAnotherAxleComesIntoSightAreMeasuredAnew) {
  std::vector<TrackedObject> tracks{vehicle(1, 50.0, -3.0, 5.0), vehicle(2, 58.0, -3.0, 4.0)};
  drive(tracks, 2.0, 0.0);
  tracks[1].state.mean.x() -= 0.6;
  drive(tracks, 2.0, 0.0);
  EXPECT_FALSE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m))
      << "it has not kept its distance for three seconds";
  EXPECT_GT(piece_wait_s(tracks[1]), tracks[1].age_s);
  drive(tracks, 2.5, 0.0);
  EXPECT_TRUE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m));
}

TEST(Pieces, MayBeginWithAScanThatIsOff) {
  std::vector<TrackedObject> tracks{vehicle(1, 50.0, -3.0, 5.0), vehicle(2, 57.0, -3.0, 4.0)};
  drive(tracks, kScan_s, 0.0);
  tracks[1].state.mean.x() += 1.2;
  drive(tracks, 5.0, 0.0);
  EXPECT_TRUE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m));
}

TEST(Pieces, BeginWhereANewTrackHasSettled) {
  std::vector<TrackedObject> tracks{vehicle(1, 50.0, -3.0, 5.0), vehicle(2, 56.0, -3.0, 0.0)};
  drive(tracks, 0.5, 4.0);  // its first scans draw it to where the axles are that are seen then
  drive(tracks, 3.0, 0.0);
  EXPECT_FALSE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m))
      << "it has not kept its distance for three seconds";
  drive(tracks, 0.7, 0.0);
  EXPECT_TRUE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m));
}

TEST(Pieces, AreNoneThatTurnOutToBeFarAway) {
  std::vector<TrackedObject> tracks{vehicle(1, 50.0, -3.0, 5.0), vehicle(2, 59.0, -3.0, 0.0)};
  drive(tracks, kScan_s, 0.0);
  EXPECT_GT(piece_wait_s(tracks[1]), 3.0);
  tracks[1].state.mean.x() += 3.0;
  drive(tracks, kScan_s, 0.0);
  EXPECT_EQ(piece_wait_s(tracks[1]), 0.0);
}

TEST(Pieces, AreNoneThatHaveComeNearerAndThenKeepTheirDistance) {
  std::vector<TrackedObject> tracks{vehicle(1, 50.0, -3.0, 5.0), vehicle(2, 58.5, -3.0, 4.0)};
  drive(tracks, 4.0, -0.35);
  drive(tracks, 10.0, 0.0);
  EXPECT_FALSE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m)) << "it followed, and stopped behind";
}

TEST(Pieces, AreNeitherBesideNorFarNorSeenFromBehindAlone) {
  for (const auto& [behind, x_m, y_m] : {std::tuple{-3.0, 58.0, -1.0}, {-3.0, 60.0, -3.0}, {0.0, 58.0, 0.0}}) {
    std::vector<TrackedObject> tracks{vehicle(1, 50.0, behind, 5.0), vehicle(2, x_m, y_m, 4.0)};
    drive(tracks, 3.5, 0.0);
    EXPECT_FALSE(is_piece_of(tracks[1], tracks[0], kFragmentSensor_m)) << x_m << ", " << y_m;
    EXPECT_EQ(piece_wait_s(tracks[1]), 0.0);
  }
}

/// A vehicle that creeps in the right lane: a corner of its rear, and places along its flank.
struct Seen {
  double rear_m, speed_mps;
  std::vector<double> along_m;
};

/// What is tracked after eight seconds, a scan each 50 ms.
std::unique_ptr<TrackList> tracked(const std::vector<Seen>& vehicles) {
  RulesConfig config;
  config.cluster_radius_m = 2.5;  // so that the middle of a gap that a piece may have is surely no cluster's
  Tracker tracker(two_radars(), config);
  Scene scene;
  for (int i = 0; i <= 160; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    for (const Seen& seen : vehicles) {
      const double rear_m = seen.rear_m + seen.speed_mps * kScan_s * i;
      scene.add({rear_m, -2.6}, {seen.speed_mps, 0.0});
      for (const double along_m : seen.along_m) scene.add({rear_m + along_m, -2.35}, {seen.speed_mps, 0.0});
    }
    tracker.step(*scene.scan);
  }
  auto list = std::make_unique<TrackList>();
  tracker.write(*list);
  return list;
}

TEST(Pieces, OfATruckWhoseAxlesAreFarApartBecomeOneTrack) {
  const auto list = tracked({{25.0, kCreeps_mps, {0.0, 1.9, 4.3, 6.6, 9.6}}});
  ASSERT_EQ(list->number_of_tracks, 1u);
  const Track& truck = list->tracks[0];
  EXPECT_NEAR(truck.position_vehicle_m[0] - 0.5F * truck.length_m, 25.0 + 8.0 * kCreeps_mps, 0.5) << "its rear";
  EXPECT_GT(truck.length_m, 9.5F);
  EXPECT_EQ(truck.object_class, ObjectClass::kTruck);
}

TEST(Pieces, OfWhichTheRearComesIntoSightLastReachBackToIt) {
  // A truck at 20 m/s: its front half first, then, seven metres nearer, its rear.
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  double rear_m = 0.0;
  for (int i = 0; i <= 24; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    rear_m = 35.0 + 20.0 * kScan_s * i;
    for (const double along_m : {12.0, 14.0}) scene.add({rear_m + along_m, -2.35}, {20.0, 0.0});
    for (const double along_m : {0.0, 2.0, 5.0}) {
      if (i > 6) scene.add({rear_m + along_m, -2.35}, {20.0, 0.0});
    }
    tracker.step(*scene.scan);
  }
  tracker.write(*list);
  ASSERT_EQ(list->number_of_confirmed_tracks, 1u);
  // But for the margin within which a cluster is a part and starts no track, and half of the cluster.
  EXPECT_NEAR(list->tracks[0].position_vehicle_m[0] - 0.5F * list->tracks[0].length_m, rear_m, 4.0);
}

TEST(Pieces, OfTwoDriversWhoCloseUpAreTwoTracks) {
  const auto list = tracked({{25.0, 1.5, {0.5, 2.0, 4.0}}, {33.0, 1.2, {0.5, 2.0, 4.0}}});
  ASSERT_EQ(list->number_of_confirmed_tracks, 2u);
  EXPECT_NEAR(list->tracks[1].position_vehicle_m[0] - list->tracks[0].position_vehicle_m[0], 8.0 - 8.0 * 0.3, 1.0);
}

}  // namespace
}  // namespace boresight::tracking
