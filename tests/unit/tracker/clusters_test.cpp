#include <tuple>

#include <gtest/gtest.h>

#include "services/tracker/core/extent.hpp"
#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

TEST(Clusterer, GroupsWhatIsNearAndMovesAlike) {
  Scene scene;
  scene.begin(kMillisecond);
  for (const double x : {20.0, 21.5, 23.0}) scene.add({x, 0.0}, {10.0, 0.0});
  scene.add({21.0, 0.5}, {25.0, 0.0});  // in the same place, but moves otherwise
  scene.add({60.0, 10.0}, {-8.0, 0.0});
  scene.add({30.0, 5.0}, {0.0, 0.0}, Provenance::kStationary);
  scene.add({31.0, 5.0}, {9.0, 0.0}, Provenance::kGhostType2);
  Clusterer clusterer(Config{});
  const auto clusters = clusterer.find(*scene.scan);
  ASSERT_EQ(clusters.size(), 3u);
  EXPECT_EQ(clusters[0].number_of_detections, 3u);
  EXPECT_NEAR(clusters[0].position_m.x(), 21.5, 1e-5);
  EXPECT_NEAR(clusters[0].range_rate_over_ground_mps, 10.0, 1e-4);
  EXPECT_EQ(clusters[1].number_of_detections, 1u);
  EXPECT_NEAR(clusters[1].range_rate_over_ground_mps, 25.0, 0.1);
  EXPECT_EQ(clusters[2].number_of_detections, 1u);
}

TEST(Clusterer, EachDetectionCountsAsMuchAsItIsReal) {
  Scene scene;
  scene.begin(kMillisecond);
  scene.add({20.0, 0.0}, {10.0, 0.0});
  scene.add({23.0, 0.0}, {12.0, 0.0}, Provenance::kMoving, 0.75);
  scene.add({60.0, 0.0}, {10.0, 0.0}, Provenance::kMoving, 0.9);
  Clusterer clusterer(Config{});
  const auto clusters = clusterer.find(*scene.scan);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_NEAR(clusters[0].position_m.x(), 20.6, 1e-5);
  EXPECT_NEAR(clusters[0].range_rate_over_ground_mps, 10.4, 1e-4);
  EXPECT_NEAR(clusters[0].realness, (1.0 + 0.25 * 0.25) / 1.25, 1e-6);
  EXPECT_EQ(clusters[0].number_on_outline, 1u) << "a likely ghost makes no object longer";
  EXPECT_NEAR(clusters[1].realness, 0.1, 1e-6);
}

TEST(Clusterer, JoinsTwoPartsByTheirWeight) {
  Scene scene;
  scene.begin(kMillisecond);
  for (const double x : {20.0, 20.0, 20.0, 28.0}) scene.add({x, 0.0}, {10.0, 0.0});
  scene.add({60.0, 0.0}, {10.0, 0.0});
  Clusterer clusterer(Config{});
  ASSERT_EQ(clusterer.find(*scene.scan).size(), 3u);
  const auto clusters = clusterer.join(0, 1);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_NEAR(clusters[0].position_m.x(), 22.0, 1e-5);
  EXPECT_EQ(clusters[0].number_of_detections, 4u);
  EXPECT_EQ(clusters[0].number_on_outline, 4u);
  EXPECT_EQ(clusters[1].position_m.x(), 60.0);
}

TEST(Clusterer, UncertaintyIsLargestAcrossTheLineOfSight) {
  Scene scene;
  scene.begin(kMillisecond);
  scene.add({63.6, 60.0}, {10.0, 0.0});
  scene.scan->azimuth_std_rad[0] = 0.03F;
  Clusterer clusterer(Config{});
  const auto clusters = clusterer.find(*scene.scan);
  ASSERT_EQ(clusters.size(), 1u);
  const Eigen::Vector2d u = clusters[0].line_of_sight, v(-u.y(), u.x());
  EXPECT_NEAR(u.x(), std::sqrt(0.5), 1e-5);
  const double range = 60.0 * std::sqrt(2.0);
  EXPECT_NEAR(u.dot(clusters[0].covariance_m2 * u), 0.15 * 0.15, 1e-5);
  EXPECT_NEAR(v.dot(clusters[0].covariance_m2 * v), std::pow(0.03 * range, 2), 1e-3);
  EXPECT_NEAR(u.dot(clusters[0].covariance_m2 * v), 0.0, 1e-6);
}

TEST(Clusterer, IsAsStrongAsItsStrongestDetection) {
  Scene scene;
  scene.begin(kMillisecond);
  scene.add({20.0, 0.0}, {1.0, 0.0});
  scene.add({20.5, 0.0}, {1.0, 0.0});
  Clusterer clusterer(Config{});
  EXPECT_TRUE(std::isnan(clusterer.find(*scene.scan)[0].strongest_dbsm)) << "the sensor measures none";
  scene.scan->fields |= scan_field::kRcs;
  scene.scan->rcs_dbsm[0] = std::numeric_limits<float>::quiet_NaN();
  scene.scan->rcs_dbsm[1] = -7.0F;
  EXPECT_EQ(clusterer.find(*scene.scan)[0].strongest_dbsm, -7.0);
  scene.scan->rcs_dbsm[0] = 4.0F;
  EXPECT_EQ(clusterer.find(*scene.scan)[0].strongest_dbsm, 4.0);
}

TEST(Clusterer, WhatIsSeenOfPeopleWhoPassEachOtherIsOfTheNearest) {
  Scene scene;
  scene.begin(kMillisecond);
  for (const double y : {-0.1, 0.1, 0.9, 1.1}) scene.add({12.0, y}, {0.0, 1.3});
  scene.add({14.0, 0.5}, {0.0, 1.3});
  Clusterer clusterer(Config{});
  EXPECT_EQ(clusterer.find(*scene.scan).size(), 1u);
  const std::array<KnownPlace, 2> people{
      {{{12.0, 0.0}, {1.0, 0.0}, {0.5, 0.3}, true}, {{12.0, 1.0}, {1.0, 0.0}, {0.5, 0.3}, true}}};
  const auto clusters = clusterer.find(*scene.scan, people);
  ASSERT_EQ(clusters.size(), 3u);
  EXPECT_NEAR(clusters[0].position_m.y(), 0.0, 1e-6);
  EXPECT_NEAR(clusters[1].position_m.y(), 1.0, 1e-6);
  EXPECT_NEAR(clusters[2].position_m.x(), 14.0, 1e-6) << "nobody's";
}

TEST(Clusterer, WhatIsSeenOfVehiclesSideBySideIsOfTheNearestBox) {
  Scene scene;
  scene.begin(kMillisecond);
  // The flank of the one in the left lane, and the rear of the one in the own lane, less than a radius apart.
  for (const double x : {16.0, 18.0, 20.0}) scene.add({x, 2.7}, {15.0, 0.0});
  for (const double y : {-0.8, 0.8}) scene.add({17.8, y}, {14.0, 0.0});
  Clusterer clusterer(Config{});
  EXPECT_EQ(clusterer.find(*scene.scan).size(), 1u);
  const KnownPlace left{{18.0, 3.6}, {1.0, 0.0}, {2.25, 0.9}, false}, own{{20.2, 0.0}, {1.0, 0.0}, {2.25, 0.9}, false};
  const std::array<KnownPlace, 2> both{left, own};
  const auto clusters = clusterer.find(*scene.scan, both);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_NEAR(clusters[0].position_m.y(), 2.7, 1e-6);
  EXPECT_NEAR(clusters[1].position_m.y(), 0.0, 1e-6);
  // One alone takes nothing off what lies beside it: that may be of it.
  EXPECT_EQ(clusterer.find(*scene.scan, {&left, 1}).size(), 1u);
}

TEST(Clusterer, RangeRatesOfAVehicleAlongsideAreThoseThatItsVelocityShows) {
  Scene scene;
  scene.begin(kMillisecond);
  const Eigen::Vector2d velocity(20.0, 0.0);
  // The flank's ends and its middle show from −11 to 16 m/s, and a wheel what the middle does.
  for (const double x : {2.1, 3.9, 6.6}) scene.add({x, -2.2}, velocity);
  scene.add({5.6, -2.2}, {4.0, 0.0});
  Clusterer clusterer(Config{});
  EXPECT_EQ(clusterer.find(*scene.scan).size(), 3u) << "by range rate alone the middle is one with the wheel";
  KnownPlace alongside{{4.4, -3.1}, {1.0, 0.0}, {2.25, 0.9}, false, velocity};
  const auto clusters = clusterer.find(*scene.scan, {&alongside, 1});
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_EQ(clusters[0].number_of_detections, 3u);
  EXPECT_NEAR(clusters[0].range_rate_over_ground_mps, clusters[0].mean_sight.dot(velocity), 1e-4);
  EXPECT_EQ(clusters[1].number_of_detections, 1u);
  alongside.velocity_mps = {-10.0, 15.0};
  EXPECT_EQ(clusterer.find(*scene.scan, {&alongside, 1}).size(), 3u) << "a velocity that explains nothing";
}

TEST(Clusterer, NumbersThatAreNoneAreLeftOut) {
  Scene scene;
  scene.begin(kMillisecond);
  scene.add({20.0, 0.0}, {10.0, 0.0});
  scene.add({20.5, 0.0}, {10.0, 0.0});
  scene.add({21.0, 0.0}, {10.0, 0.0});
  scene.scan->x_vehicle_m[1] = std::numeric_limits<float>::quiet_NaN();
  scene.scan->range_rate_over_ground_mps[2] = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 4; ++i) scene.add({21.0, 0.5}, {10.0, 0.0});
  scene.scan->range_std_m[3] = scene.scan->azimuth_std_rad[4] = scene.scan->range_rate_std_mps[5] =
      scene.scan->ghost_probability[6] = std::numeric_limits<float>::quiet_NaN();
  Clusterer clusterer(Config{});
  const auto clusters = clusterer.find(*scene.scan);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].number_of_detections, 1u);
}

TEST(Clusterer, MoreClustersThanRoomAreCounted) {
  Scene scene;
  scene.begin(kMillisecond);
  for (int i = 0; i < 200; ++i) scene.add({10.0 + 10.0 * (i % 20), -50.0 + 10.0 * (i / 20.0)}, {10.0, 0.0});
  Config config;
  config.cluster_radius_m = 0.1;
  Clusterer clusterer(config);
  EXPECT_EQ(clusterer.find(*scene.scan).size(), geometry::Assignment::kCapacity);
  EXPECT_EQ(clusterer.dropped(), 200u - geometry::Assignment::kCapacity);
}

TEST(Extent, HidesWhatLiesBehindIt) {
  Extent car;
  car.heading_rad = 90.0 * kDegree;
  car.length_m = 4.0;
  car.width_m = 2.0;
  const Eigen::Vector2d centre(10.0, 0.0);
  EXPECT_TRUE(car.hides(centre, {0.0, 0.0}, {20.0, 0.0}));
  EXPECT_TRUE(car.hides(centre, {0.0, 1.9}, {20.0, 1.9})) << "it is 4 m wide across";
  EXPECT_FALSE(car.hides(centre, {0.0, 2.1}, {20.0, 2.1})) << "beside";
  EXPECT_FALSE(car.hides(centre, {0.0, 0.0}, {8.0, 0.0})) << "before";
  EXPECT_FALSE(car.hides(centre, {0.0, 0.0}, {10.0, 0.5})) << "in it";
  EXPECT_FALSE(car.hides(centre, {15.0, 0.0}, {20.0, 0.0})) << "behind both";
}

TEST(Extent, KnowsWhichFacesAreSeen) {
  const Extent car{.heading_rad = 0.0, .length_m = 4.0, .width_m = 2.0};
  const Eigen::Vector2d centre(30.0, 0.0);
  const VisibleFaces from_behind = car.visible_faces(centre, {0.0, 0.0});
  EXPECT_EQ(from_behind.end, -1.0);
  EXPECT_EQ(from_behind.side, 0.0);
  const VisibleFaces from_aside = car.visible_faces(centre, {0.0, 20.0});
  EXPECT_EQ(from_aside.end, -1.0);
  EXPECT_EQ(from_aside.side, 1.0);
  const VisibleFaces from_inside = car.visible_faces(centre, centre);
  EXPECT_EQ(from_inside.end, 0.0);
  EXPECT_EQ(from_inside.side, 0.0);
}

TEST(Extent, OfWhatIsNearbyEachScanShowsAPieceOnly) {
  Extent near{.heading_rad = 0.0, .length_m = 16.0, .width_m = 2.5}, far = near;
  const Eigen::Vector2d centre(0.0, -3.5), velocity(20.0, 0.0);
  Cluster cluster{};
  cluster.strongest_dbsm = std::numeric_limits<double>::quiet_NaN();
  cluster.number_on_outline = 2;
  cluster.outline[0] = {3.0, -2.2};
  cluster.outline[1] = {7.0, -2.2};
  for (int i = 0; i < 100; ++i) {
    std::ignore = near.update(cluster, centre, velocity, {0.0, 0.0}, false);
    std::ignore = far.update(cluster, centre, velocity, {0.0, 40.0}, false);
  }
  EXPECT_GT(near.length_m, 14.0) << "alongside";
  EXPECT_LT(far.length_m, 12.0);
}

TEST(Extent, GrowsToWhatIsSeenBeyondItsEnd) {
  const Extent before{.heading_rad = M_PI / 2, .length_m = 10.0, .width_m = 2.0};
  const Eigen::Vector2d centre(5.0, 20.0), beside(0.0, 20.0);
  Cluster cluster{};
  cluster.number_on_outline = 1;
  cluster.outline[0] = {4.0, 28.0};  // 3 m beyond the front
  Extent box = before;
  Eigen::Vector2d place = centre;
  for (int i = 0; i < 50; ++i) place += box.grow_to(cluster, place, beside, 1.0);
  EXPECT_NEAR(box.length_m, 12.0, 1e-3);
  EXPECT_NEAR(place.y() - 0.5 * box.length_m, 15.0, 1e-9) << "the rear stays where it is";
  EXPECT_NEAR(place.x(), 5.0, 1e-9);
  box = before;
  EXPECT_EQ(box.grow_to(cluster, centre, {5.0, 0.0}, 1.0), Eigen::Vector2d(0.0, 0.0)) << "its ghost, from behind";
  EXPECT_EQ(box.grow_to(cluster, centre, beside, 4.0), Eigen::Vector2d(0.0, 0.0)) << "as the place is not known";
  EXPECT_EQ(box.length_m, 10.0);
  Extent car{.heading_rad = M_PI / 2, .length_m = 4.5, .width_m = 1.8};
  EXPECT_EQ(car.grow_to(cluster, centre, beside, 1.0), Eigen::Vector2d(0.0, 0.0)) << "the next car";
}

TEST(Extent, WhoWasTakenForAVehicleThatPassedIsSmallAgain) {
  const auto hear = [](Extent& extent, double dbsm) {
    for (int i = 0; i < 30; ++i) extent.hear(dbsm, 1.4);
  };
  Extent person, car;
  hear(person, -5.0);
  EXPECT_TRUE(person.is_small);
  hear(person, 12.0);
  EXPECT_FALSE(person.is_small);
  EXPECT_EQ(person.length_m, Extent::kCarLength_m);
  hear(person, 1.0);
  EXPECT_FALSE(person.is_small) << "not at the first doubt";
  hear(person, -5.0);
  EXPECT_TRUE(person.is_small);
  EXPECT_LT(person.length_m, 1.5);
  // What began as a vehicle and is hardly seen any more stays one.
  hear(car, 12.0);
  hear(car, -5.0);
  EXPECT_FALSE(car.is_small);
}

TEST(Extent, WhoseSideIsWeakAndShortIsNoVehicle) {
  const Eigen::Vector2d velocity(0.0, 1.4), sensor(0.0, 0.0);
  Cluster cluster{};
  cluster.number_of_detections = cluster.number_on_outline = 3;
  const auto see = [&](Extent& box, double dbsm, double length_m) {
    cluster.strongest_dbsm = dbsm;
    for (int i = 0; i < 60; ++i) {
      cluster.outline = {{{8.0, -0.5 * length_m}, {8.0, 0.0}, {8.0, 0.5 * length_m}}};
      std::ignore = box.update(cluster, {8.5, 0.0}, velocity, sensor, false);
    }
  };
  // Something strong was near when they came into sight.
  const auto begun = [] {
    Extent box{.heading_rad = M_PI / 2};
    box.hear(10.0, 1.4);
    return box;
  };
  Extent person = begun(), car = begun(), end_of_a_car = begun(), long_one = begun();
  see(person, -9.0, 0.5);
  EXPECT_TRUE(person.is_small);
  EXPECT_LT(person.length_m, 1.3);
  see(car, 8.0, 0.5);
  EXPECT_FALSE(car.is_small) << "of a strong side only a part was seen";
  EXPECT_GT(car.length_m, 2.5);
  see(long_one, -9.0, 4.0);
  EXPECT_FALSE(long_one.is_small) << "weak, but as long as a car";
  end_of_a_car.heading_rad = 0.0;
  see(end_of_a_car, -9.0, 0.5);
  EXPECT_FALSE(end_of_a_car.is_small) << "its side was not seen";
}

TEST(Extent, GrowsAwayFromTheFacesThatAreSeen) {
  Extent box{.heading_rad = 0.4, .length_m = 4.0, .width_m = 1.8};
  const Eigen::Vector2d centre(20.0, 5.0), velocity(10.0, 0.0), sensor(0.0, 0.0);
  const VisibleFaces faces = box.visible_faces(centre, sensor);
  ASSERT_NE(faces.end, 0.0);
  ASSERT_NE(faces.side, 0.0);
  const auto corner = [&](const Eigen::Vector2d& middle) -> Eigen::Vector2d {
    return middle + box.from_body({0.5 * faces.end * box.length_m, 0.5 * faces.side * box.width_m});
  };
  Cluster cluster{};
  cluster.strongest_dbsm = 10.0;
  cluster.number_on_outline = 2;
  cluster.outline[0] = corner(centre);
  cluster.outline[1] = cluster.outline[0] - box.from_body({faces.end * 7.0, 0.0});
  const Eigen::Vector2d before = corner(centre);
  Eigen::Vector2d middle = centre;
  for (int i = 0; i < 10; ++i) middle += box.update(cluster, middle, velocity, sensor, false);
  EXPECT_GT(box.length_m, 6.0);
  EXPECT_LT((corner(middle) - before).norm(), 1e-9) << "the corner that is seen stays where it is";
}

TEST(Extent, GrowsWithWhatIsSeenAndKeepsWhatIsNot) {
  Extent extent;
  Cluster cluster{};
  cluster.number_of_detections = cluster.number_on_outline = 2;
  cluster.outline[0] = {20.0, -0.9};
  cluster.outline[1] = {20.0, 0.9};
  for (int i = 0; i < 300; ++i) std::ignore = extent.update(cluster, {22.0, 0.0}, {10.0, 0.0}, {0.0, 0.0}, true);
  EXPECT_NEAR(extent.length_m, 4.5, 1e-9) << "from behind the length is not seen";
  EXPECT_NEAR(extent.width_m, 1.8, 0.01);
  cluster.outline[1] = {28.0, -0.9};
  for (int i = 0; i < 20; ++i) std::ignore = extent.update(cluster, {24.0, 0.0}, {10.0, 0.0}, {0.0, -20.0}, true);
  EXPECT_NEAR(extent.length_m, 8.0, 0.05);
  EXPECT_EQ(extent.object_class(), ObjectClass::kTruck);
  cluster.outline[1] = {22.0, -0.9};
  for (int i = 0; i < 20; ++i) std::ignore = extent.update(cluster, {24.0, 0.0}, {10.0, 0.0}, {0.0, -20.0}, true);
  EXPECT_GT(extent.length_m, 7.0) << "a few scans that show a part of it";
  for (int i = 0; i < 2000; ++i) std::ignore = extent.update(cluster, {24.0, 0.0}, {10.0, 0.0}, {0.0, -20.0}, true);
  EXPECT_NEAR(extent.length_m, 2.0, 0.1);
}

TEST(Extent, IsAPersonsAsLongAsItReflectsAndMovesAsOne) {
  Extent person;
  person.hear(-6.0, 1.4);
  EXPECT_LT(person.length_m, 2.0);
  EXPECT_LT(person.width_m, 1.0);
  for (int i = 0; i < 5; ++i) person.hear(-14.0, 1.4);
  EXPECT_TRUE(person.is_small) << "limbs only";
  Cluster two{};
  two.number_of_detections = two.number_on_outline = 2;
  two.outline[0] = {10.0, -2.0};
  two.outline[1] = {10.0, 2.0};
  for (int i = 0; i < 20; ++i) std::ignore = person.update(two, {10.0, 0.0}, {0.0, 1.4}, {0.0, 0.0}, false);
  EXPECT_LE(person.length_m, 2.0) << "no longer than a cycle, whoever is beside";
  person.hear(5.0, 1.4);
  EXPECT_TRUE(person.is_small) << "one strong echo";
  for (int i = 0; i < 20; ++i) person.hear(10.0, 1.4);
  EXPECT_FALSE(person.is_small) << "a car that showed its wheels first";
  EXPECT_EQ(person.length_m, 4.5);
  EXPECT_EQ(person.width_m, 1.8);

  for (const auto& [dbsm, speed_mps] : {std::pair{8.0, 1.4}, std::pair{-6.0, 12.0}, std::pair{-20.0, 1.4},
                                        std::pair{std::numeric_limits<double>::quiet_NaN(), 1.4}}) {
    Extent vehicle;
    vehicle.hear(dbsm, speed_mps);
    EXPECT_EQ(vehicle.length_m, 4.5) << dbsm << " dBsm, " << speed_mps << " m/s";
  }
}

TEST(Extent, ShowsItsSideToWhoStandsBesideItsTrack) {
  const Extent box{.heading_rad = M_PI / 2, .length_m = 4.0, .width_m = 2.0};
  const Eigen::Vector2d centre(5.0, 10.0);
  EXPECT_FALSE(box.shows_side(centre, {5.0, -30.0}));
  EXPECT_FALSE(box.shows_side(centre, {6.9, -30.0})) << "its own lane";
  EXPECT_TRUE(box.shows_side(centre, {7.1, -30.0}));
  EXPECT_TRUE(box.shows_side(centre, {2.9, 10.0}));
}

TEST(Extent, IsAsWideAsVehiclesAre) {
  Extent wide{.heading_rad = 0.0, .length_m = 4.5, .width_m = 1.9}, narrow = wide;
  const Eigen::Vector2d centre(20.0, 0.0), velocity(10.0, 0.0), sensor(3.6, 0.0);
  Cluster cluster{};
  cluster.strongest_dbsm = std::numeric_limits<double>::quiet_NaN();
  cluster.number_on_outline = 3;
  for (int i = 0; i < 400; ++i) {
    cluster.outline[0] = {18.0, -2.5};
    cluster.outline[1] = {18.0, 2.5};
    cluster.outline[2] = {22.0, 0.0};
    std::ignore = wide.update(cluster, centre, velocity, sensor, false);
    cluster.outline[0] = {18.0, -0.1};
    cluster.outline[1] = {18.0, 0.1};
    std::ignore = narrow.update(cluster, centre, velocity, sensor, false);
  }
  EXPECT_NEAR(wide.width_m, 2.6, 1e-6);
  EXPECT_NEAR(narrow.width_m, 1.6, 1e-6);
}

TEST(Extent, LengthensToReachAnother) {
  Extent rear{.heading_rad = M_PI / 2, .length_m = 4.0, .width_m = 2.0};
  const Extent front{.heading_rad = M_PI / 2, .length_m = 3.0, .width_m = 2.0};
  const Eigen::Vector2d centre(5.0, 10.0), ahead(5.3, 15.0);
  EXPECT_TRUE(rear.in_file(centre, front, ahead, 2.0));
  EXPECT_FALSE(rear.in_file(centre, front, ahead, 1.0));
  EXPECT_FALSE(rear.in_file(centre, front, {6.5, 15.0}, 2.0)) << "beside its track";
  const Eigen::Vector2d moved = rear.lengthen(centre, ahead);
  EXPECT_NEAR(rear.length_m, 7.0, 1e-12);
  EXPECT_NEAR(moved.y(), 11.5, 1e-12);
  EXPECT_NEAR(moved.x(), 5.0, 1e-12);
}

}  // namespace
}  // namespace boresight::tracking
