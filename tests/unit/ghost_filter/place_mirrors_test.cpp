// Which sides of tracked vehicles may mirror.
#include "services/ghost_filter/core/classify/place_mirrors.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::ghosts {

namespace {

using Eigen::Vector2d;

/// How likely the side is one that looks across the vehicle's axis, of a vehicle beside the sensor; 0: there is none.
double flank_of(double length_m, double beside_m, double weight = 1.0, double learnt = 0.0) {
  Object o;
  o.position_m = {3.0, beside_m};
  o.half_length_m = 0.5 * length_m;
  o.half_width_m = 0.9;
  o.weight = weight;
  o.mirrors = learnt;
  o.position_covariance = 0.01 * Eigen::Matrix2d::Identity();
  const std::vector<Object> objects{o};
  Odometry odometry;
  static_cast<void>(odometry.advance(1'000'000'000, 0.0, 0.0));
  std::vector<Mirror> mirrors;
  mirrors.reserve(8);
  place_mirrors({}, odometry, objects, {3.6, 0.0}, ClassConfig{}, mirrors);
  for (const Mirror& m : mirrors) {
    if (std::abs(m.curve.tangent.x()) > 0.9) {
      // The side that the sensor sees.
      EXPECT_NEAR(m.curve.origin_m.y(), beside_m - 0.9, 1e-9);
      EXPECT_GT(m.end_m, 0.5 * length_m) << "its far corner is not seen";
      return m.existence;
    }
  }
  return 0.0;
}

}  // namespace

TEST(PlaceMirrors, ALongVehiclesFlankIsAMirrorNearAndFar) {
  EXPECT_GT(flank_of(12.0, 5.0), 0.7);
  EXPECT_GT(flank_of(12.0, 60.0), 0.7);
  EXPECT_EQ(flank_of(12.0, 5.0, 0.3), 0.0) << "an image rather than a vehicle";
}

TEST(PlaceMirrors, WhatLooksLikeACarMayBeAVanWhereManyRaysMeetIt) {
  // A van's track, beside, still has the length of a car; and a car's may be one.
  EXPECT_GT(flank_of(4.5, 5.0), 0.1);
  EXPECT_LT(flank_of(4.5, 5.0), 0.4);
  EXPECT_GT(flank_of(3.9, 5.0), 0.1) << "most of a flank alongside has no range rate";
  EXPECT_EQ(flank_of(4.5, 60.0), 0.0);
  EXPECT_EQ(flank_of(1.8, 5.0), 0.0) << "a cycle";
}

TEST(PlaceMirrors, WhatShowedImagesIsBelievedToMirror) {
  EXPECT_GT(flank_of(4.5, 5.0, 1.0, 4.0), 0.85) << "it is a van";
  EXPECT_GT(flank_of(12.0, 5.0, 1.0, 4.0), flank_of(12.0, 5.0));
  EXPECT_LE(flank_of(12.0, 5.0, 1.0, 4.0), 1.0);
  EXPECT_LT(flank_of(12.0, 5.0, 0.6, 4.0), 0.6) << "but it may be no vehicle at all";
}

TEST(PlaceMirrors, EndsOfAVehicleAreKnownAsItsTrackKnowsThem) {
  Mirror side;
  side.curve = {{5.0, 3.0}, {1.0, 0.0}, 0.0};
  side.begin_m = -2.0;
  side.end_m = 2.0;
  side.existence = 1.0;
  EXPECT_GT(chance_at(side, 0.0, 0.1), 0.98);
  EXPECT_NEAR(chance_at(side, 2.0, 0.1), 0.5, 1e-3);
  EXPECT_GT(chance_at(side, 2.5, 0.1), 0.15) << "its track may be too short";
  EXPECT_LT(chance_at(side, 4.5, 0.1), 0.01);
}

}  // namespace boresight::ghosts
