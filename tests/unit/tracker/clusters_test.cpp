#include <gtest/gtest.h>

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
  Clusterer clusterer(RulesConfig{});
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
  Clusterer clusterer(RulesConfig{});
  const auto clusters = clusterer.find(*scene.scan);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_NEAR(clusters[0].position_m.x(), 20.6, 1e-5);
  EXPECT_NEAR(clusters[0].range_rate_over_ground_mps, 10.4, 1e-4);
  EXPECT_NEAR(clusters[0].realness, (1.0 + 0.25 * 0.25) / 1.25, 1e-6);
  EXPECT_EQ(clusters[0].number_on_outline, 1u) << "a likely ghost makes no object longer";
  EXPECT_NEAR(clusters[1].realness, 0.1, 1e-6);
}

TEST(Clusterer, WheelsHaveNoPartInTheBodysRangeRate) {
  Scene scene;
  scene.begin(kMillisecond);
  for (const double x : {20.0, 20.5, 21.0}) scene.add({x, 0.0}, {2.0, 0.0});
  scene.add({21.5, 0.0}, {3.9, 0.0});
  Clusterer clusterer(RulesConfig{});
  ASSERT_EQ(clusterer.find(*scene.scan).size(), 1u);
  EXPECT_NEAR(clusterer.find(*scene.scan)[0].range_rate_over_ground_mps, 2.0, 1e-4);
  EXPECT_NEAR(clusterer.find(*scene.scan)[0].position_m.x(), 20.75, 1e-5) << "but they are where it is";
  // Of as many others nobody knows which are the body.
  scene.add({19.5, 0.0}, {3.9, 0.0});
  scene.add({19.0, 0.0}, {3.9, 0.0});
  scene.scan->range_rate_over_ground_mps[2] = 2.9F;
  EXPECT_NEAR(clusterer.find(*scene.scan)[0].range_rate_over_ground_mps, (2 * 2.0 + 2.9 + 3 * 3.9) / 6.0, 1e-4);
}

TEST(Clusterer, JoinsTwoPartsByTheirWeight) {
  Scene scene;
  scene.begin(kMillisecond);
  for (const double x : {20.0, 20.0, 20.0, 28.0}) scene.add({x, 0.0}, {10.0, 0.0});
  scene.add({60.0, 0.0}, {10.0, 0.0});
  Clusterer clusterer(RulesConfig{});
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
  Clusterer clusterer(RulesConfig{});
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
  Clusterer clusterer(RulesConfig{});
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
  Clusterer clusterer(RulesConfig{});
  EXPECT_EQ(clusterer.find(*scene.scan).size(), 1u);
  const std::array<KnownPlace, 2> people{
      {{{12.0, 0.0}, {1.0, 0.0}, {0.5, 0.3}, true}, {{12.0, 1.0}, {1.0, 0.0}, {0.5, 0.3}, true}}};
  const auto clusters = clusterer.find(*scene.scan, people);
  ASSERT_EQ(clusters.size(), 3u);
  EXPECT_NEAR(clusters[0].position_m.y(), 0.0, 1e-6);
  EXPECT_NEAR(clusters[1].position_m.y(), 1.0, 1e-6);
  EXPECT_NEAR(clusters[2].position_m.x(), 14.0, 1e-6) << "nobody's";
}

TEST(Clusterer, WhatNoLimbShowsIsNotOfThePersonBesideACar) {
  Scene scene;
  scene.begin(kMillisecond);
  const Eigen::Vector2d walks(-1.2, 0.0), drives(3.5, 0.0);
  // A leg that stands, the trunk, a leg that swings; and the near corner of a car that drives away beside them.
  for (const double share : {0.1, 1.0, 1.8}) scene.add({12.3, -1.9}, share * walks);
  for (const double y : {-0.95, 0.0, 0.95}) scene.add({11.8, y}, drives);
  const std::array<KnownPlace, 2> both{
      {{{12.3, -1.9}, {-1.0, 0.0}, {0.5, 0.3}, true, walks}, {{14.0, 0.0}, {1.0, 0.0}, {2.25, 0.95}, false, drives}}};
  Clusterer clusterer(RulesConfig{});
  const auto clusters = clusterer.find(*scene.scan, both);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_EQ(clusters[0].number_of_detections, 3u);
  EXPECT_NEAR(clusters[0].position_m.y(), -1.9, 1e-6);
  EXPECT_EQ(clusters[1].number_of_detections, 3u);
  EXPECT_NEAR(clusters[1].range_rate_over_ground_mps, 3.5, 0.1);
}

TEST(Clusterer, WhatIsSeenOfVehiclesSideBySideIsOfTheNearestBox) {
  Scene scene;
  scene.begin(kMillisecond);
  // The flank of the one in the left lane, and the rear of the one in the own lane, less than a radius apart.
  for (const double x : {16.0, 18.0, 20.0}) scene.add({x, 2.7}, {15.0, 0.0});
  for (const double y : {-0.8, 0.8}) scene.add({17.8, y}, {14.0, 0.0});
  Clusterer clusterer(RulesConfig{});
  EXPECT_EQ(clusterer.find(*scene.scan).size(), 1u);
  const KnownPlace left{{18.0, 3.6}, {1.0, 0.0}, {2.25, 0.9}, false}, own{{20.2, 0.0}, {1.0, 0.0}, {2.25, 0.9}, false};
  const std::array<KnownPlace, 2> both{left, own};
  const auto clusters = clusterer.find(*scene.scan, both);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_NEAR(clusters[0].position_m.y(), 2.7, 1e-6);
  EXPECT_NEAR(clusters[1].position_m.y(), 0.0, 1e-6);
}

TEST(Clusterer, WhatLiesBesideOneVehicleIsAnothersIfItMovesOtherwise) {
  Scene scene;
  scene.begin(kMillisecond);
  // A truck's flank and, in the next lane, the rear of a car that no track is of yet.
  for (const double x : {16.0, 18.0, 20.0}) scene.add({x, -2.4}, {1.2, 0.0});
  for (const double y : {0.4, 1.0}) scene.add({17.8, y}, {1.6, 0.0});
  Clusterer clusterer(RulesConfig{});
  KnownPlace truck{{22.0, -3.6}, {1.0, 0.0}, {8.25, 1.25}, false, {1.2, 0.0}};
  const auto clusters = clusterer.find(*scene.scan, {&truck, 1});
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_NEAR(clusters[0].position_m.y(), -2.4, 1e-6);
  EXPECT_NEAR(clusters[1].position_m.y(), 0.7, 1e-6);
  EXPECT_NEAR(clusters[1].range_rate_over_ground_mps, 1.6, 0.02);
  // One alone takes nothing off what moves as it does: that may be of it.
  truck.velocity_mps = {1.55, 0.0};
  EXPECT_EQ(clusterer.find(*scene.scan, {&truck, 1}).size(), 1u);
}

TEST(Clusterer, RangeRatesOfAVehicleAlongsideAreThoseThatItsVelocityShows) {
  Scene scene;
  scene.begin(kMillisecond);
  const Eigen::Vector2d velocity(20.0, 0.0);
  // The flank's ends and its middle show from −11 to 16 m/s, and a wheel what the middle does.
  for (const double x : {2.1, 3.9, 6.6}) scene.add({x, -2.2}, velocity);
  scene.add({5.6, -2.2}, {4.0, 0.0});
  Clusterer clusterer(RulesConfig{});
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
      scene.scan->probability(Provenance::kClutter, 6) = std::numeric_limits<float>::quiet_NaN();
  Clusterer clusterer(RulesConfig{});
  const auto clusters = clusterer.find(*scene.scan);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].number_of_detections, 1u);
}

TEST(Clusterer, MoreClustersThanRoomAreCounted) {
  Scene scene;
  scene.begin(kMillisecond);
  for (int i = 0; i < 200; ++i) scene.add({10.0 + 10.0 * (i % 20), -50.0 + 10.0 * (i / 20.0)}, {10.0, 0.0});
  RulesConfig config;
  config.cluster_radius_m = 0.1;
  Clusterer clusterer(config);
  EXPECT_EQ(clusterer.find(*scene.scan).size(), geometry::Assignment::kCapacity);
  EXPECT_EQ(clusterer.dropped(), 200u - geometry::Assignment::kCapacity);
}

}  // namespace
}  // namespace boresight::tracking
