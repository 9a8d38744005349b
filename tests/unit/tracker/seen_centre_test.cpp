// Where a box's middle is by what is seen of its faces.
#include "services/tracker/core/seen_centre.hpp"

#include <cmath>
#include <initializer_list>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using namespace boresight::tracking;

namespace {

constexpr double kNoise_m = 0.05;
const Extent kCar{.heading_rad = 0.0, .length_m = 4.0, .width_m = 2.0};
const Eigen::Vector2d kCentre(30.0, 10.0), kSensor(0.0, 0.0);
const Eigen::Matrix2d kKnown_m2 = 0.25 * Eigen::Matrix2d::Identity();  // how well the middle was known

/// Detections at these places, each with that noise in every direction.
Cluster cluster_of(const std::vector<Eigen::Vector2d>& places, double noise_m = kNoise_m) {
  Cluster cluster{};
  cluster.position_m.setZero();
  for (const Eigen::Vector2d& place : places) {
    cluster.outline[cluster.number_on_outline++] = place;
    cluster.position_m += place / static_cast<double>(places.size());
  }
  cluster.number_of_detections = cluster.number_on_outline;
  cluster.weight = static_cast<double>(places.size());
  cluster.covariance_m2 = noise_m * noise_m / cluster.weight * Eigen::Matrix2d::Identity();
  return cluster;
}

/// The same, relative to the middle of the box.
Cluster seen_of(const Extent& box, const Eigen::Vector2d& centre, std::initializer_list<Eigen::Vector2d> places) {
  std::vector<Eigen::Vector2d> there;
  for (const Eigen::Vector2d& place : places) there.push_back(centre + box.from_body(place));
  return cluster_of(there);
}

TEST(SeenCentre, EachFaceTellsHowFarItIsHoweverManyDetectionsItHas) {
  // The rear and the right side look to the sensor. The box was thought to be too far ahead and to the left.
  const Eigen::Vector2d thought = kCentre + Eigen::Vector2d(0.3, 0.2);
  const SeenCentre few =
      seen_centre(seen_of(kCar, kCentre, {{-2.0, 0.0}, {-2.0, -0.2}, {0.0, -1.0}}), kCar, thought, kKnown_m2, kSensor);
  EXPECT_LT((few.at_m - kCentre).norm(), 0.1);
  const SeenCentre many = seen_centre(
      seen_of(kCar, kCentre,
              {{-2.0, 0.0}, {-1.2, -1.0}, {-0.6, -1.0}, {0.0, -1.0}, {0.6, -1.0}, {1.2, -1.0}, {1.4, -1.0}}),
      kCar, thought, kKnown_m2, kSensor);
  EXPECT_LT((many.at_m - kCentre).norm(), 0.1);
}

TEST(SeenCentre, WhatLiesFartherOffThanTheRestCountsLess) {
  // The car in the next lane, in one cluster with it, as azimuths are known badly.
  const std::initializer_list<Eigen::Vector2d> own{{-2.0, -0.5}, {-2.0, 0.5}, {-2.0, 0.0}};
  const std::initializer_list<Eigen::Vector2d> both{{-2.0, -0.5}, {-2.0, 0.5}, {-2.0, 0.0}, {-1.0, 3.0}, {-1.0, 4.0}};
  const Eigen::Vector2d centre(30.0, 0.0);
  const SeenCentre alone = seen_centre(seen_of(kCar, centre, own), kCar, centre, kKnown_m2, kSensor);
  const SeenCentre beside = seen_centre(seen_of(kCar, centre, both), kCar, centre, kKnown_m2, kSensor);
  EXPECT_LT((beside.at_m - alone.at_m).norm(), 0.35) << "the mean would be 1.4 m off";
  // But where everything is off the box is.
  const Eigen::Vector2d away(0.0, 3.0);
  const SeenCentre all = seen_centre(seen_of(kCar, centre + away, own), kCar, centre, kKnown_m2, kSensor);
  EXPECT_LT((all.at_m - centre - away).norm(), 0.2);
  EXPECT_LT(all.covariance_m2(1, 1), 1.5 * alone.covariance_m2(1, 1)) << "it is told no less certainly";
}

TEST(SeenCentre, ASideSaysLittleOfWhereAlongItTheMiddleIs) {
  const Extent truck{.heading_rad = 0.0, .length_m = 12.0, .width_m = 2.5};
  const Eigen::Vector2d beside(30.0, -10.0);
  const SeenCentre seen = seen_centre(seen_of(truck, kCentre, {{2.0, -1.25}, {4.0, -1.25}, {6.0, -1.25}}), truck,
                                      kCentre, kKnown_m2, beside);
  // Evenly anywhere along 12 m: a variance of 12 m², for all three as for one.
  EXPECT_NEAR(seen.covariance_m2(0, 0), 12.0 + kNoise_m * kNoise_m / 3.0, 1e-9);
  EXPECT_NEAR(seen.at_m.x(), kCentre.x() + 4.0, 1e-9);
  EXPECT_LT(seen.covariance_m2(1, 1), 0.02);
  EXPECT_NEAR(seen.at_m.y(), kCentre.y(), 1e-9);
}

TEST(SeenCentre, FromBehindTheRearSaysHowFarAwayItIs) {
  const Eigen::Vector2d centre(30.0, 0.0);
  const SeenCentre seen = seen_centre(seen_of(kCar, centre, {{-2.0, -0.9}, {-2.0, 0.1}}), kCar,
                                      centre + Eigen::Vector2d(1.0, 0.0), kKnown_m2, kSensor);
  EXPECT_NEAR(seen.at_m.x(), centre.x(), 1e-9);
  EXPECT_NEAR(seen.at_m.y(), -0.4, 1e-9) << "the mean of what is seen across";
  EXPECT_LT(seen.covariance_m2(0, 0), seen.covariance_m2(1, 1));
}

TEST(SeenCentre, TurnsWithTheBox) {
  const std::initializer_list<Eigen::Vector2d> places{{-2.0, -0.3}, {0.3, -0.9}, {1.1, -1.2}};
  const SeenCentre straight =
      seen_centre(seen_of(kCar, kCentre, places), kCar, kCentre + Eigen::Vector2d(0.2, 0.1), kKnown_m2, kSensor);
  for (const double angle : {0.3, 1.7, -2.5}) {
    const Eigen::Rotation2Dd turn(angle);
    const Extent turned{.heading_rad = angle, .length_m = kCar.length_m, .width_m = kCar.width_m};
    const SeenCentre seen = seen_centre(seen_of(turned, turn * kCentre, places), turned,
                                        turn * (kCentre + Eigen::Vector2d(0.2, 0.1)), kKnown_m2, turn * kSensor);
    EXPECT_LT((seen.at_m - turn * straight.at_m).norm(), 1e-9);
    const Eigen::Matrix2d rotation = turn.toRotationMatrix();
    EXPECT_LT((seen.covariance_m2 - rotation * straight.covariance_m2 * rotation.transpose()).norm(), 1e-9);
  }
}

TEST(SeenCentre, ErrsAsMuchAsItSays) {
  // Against an independent simulation: detections even along both faces, with noise.
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.2);
  std::uniform_real_distribution<double> even(-0.5, 0.5);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero(), said = Eigen::Matrix2d::Zero();
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<Eigen::Vector2d> places;
    for (int i = 0; i < 2; ++i) places.emplace_back(-2.0, 2.0 * even(random));
    for (int i = 0; i < 4; ++i) places.emplace_back(4.0 * even(random), -1.0);
    for (Eigen::Vector2d& place : places) place += kCentre + Eigen::Vector2d(noise(random), noise(random));
    const SeenCentre seen = seen_centre(cluster_of(places, 0.2), kCar, kCentre, kKnown_m2, kSensor);
    const Eigen::Vector2d error = seen.at_m - kCentre;
    sum += error * error.transpose() / kRuns;
    said += seen.covariance_m2 / kRuns;
  }
  // It allows for faces that are rough, which these are not; and near the corner some are taken for the other face's.
  for (const int axis : {0, 1}) {
    EXPECT_LT(sum(axis, axis), said(axis, axis));
    EXPECT_GT(sum(axis, axis), 0.3 * said(axis, axis));
  }
}

TEST(SeenCentre, PeopleHaveNoFaces) {
  Extent person{.heading_rad = 0.0, .length_m = 1.2, .width_m = 0.7};
  person.is_small = true;
  const Cluster cluster = cluster_of({{9.8, 0.1}, {10.0, -0.1}});
  EXPECT_EQ(seen_centre(cluster, person, {10.5, 0.0}, kKnown_m2, kSensor).at_m, cluster.position_m);
}

TEST(SeenCentre, OfWhatHasNoOutlineTheMeanCounts) {
  Cluster ghosts = cluster_of({{28.0, 10.0}});
  ghosts.number_on_outline = 0;
  const SeenCentre seen = seen_centre(ghosts, kCar, kCentre + Eigen::Vector2d(0.3, 0.0), kKnown_m2, kSensor);
  EXPECT_NEAR(seen.at_m.x(), kCentre.x(), 1e-9);
}

TEST(SeenCentre, ASensorThatSaysItHasNoNoiseIsNoHindrance) {
  const Eigen::Vector2d centre(30.0, 0.0);
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(28.0, 0.0), Eigen::Vector2d(30.0, -1.0)}) {
    const SeenCentre seen = seen_centre(cluster_of({place}, 0.0), kCar, centre, kKnown_m2, kSensor);
    EXPECT_TRUE(seen.at_m.allFinite() && seen.covariance_m2.allFinite());
  }
}

TEST(SeenCentre, FromInsideItIsAnywhereInTheBox) {
  const SeenCentre seen = seen_centre(cluster_of({{30.4, 10.2}}), kCar, kCentre, kKnown_m2, kCentre);
  EXPECT_LT((seen.at_m - Eigen::Vector2d(30.4, 10.2)).norm(), 1e-9);
  EXPECT_NEAR(seen.covariance_m2(0, 0), 16.0 / 12.0 + kNoise_m * kNoise_m, 1e-9);
  EXPECT_NEAR(seen.covariance_m2(1, 1), 4.0 / 12.0 + kNoise_m * kNoise_m, 1e-9);
}

}  // namespace
