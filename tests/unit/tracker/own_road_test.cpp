// How the own road runs, as the own course tells it.
#include "services/tracker/core/own_road.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight::tracking {
namespace {

OwnRoad driving(double speed_mps, double yaw_rate_radps) {
  ScanGeometry geometry{};
  geometry.ego_speed_mps = static_cast<float>(speed_mps);
  geometry.ego_yaw_rate_radps = static_cast<float>(yaw_rate_radps);
  return OwnRoad(geometry);
}

TEST(OwnRoad, IsACircleOfTheOwnCurvature) {
  constexpr double kRadius_m = 400.0, kSpeed_mps = 20.0;
  for (const double side : {1.0, -1.0}) {
    const OwnRoad road = driving(kSpeed_mps, side * kSpeed_mps / kRadius_m);
    for (const double turned_rad : {-0.2, 0.09, 0.25}) {
      // The road and the lanes beside it, on circles about one middle.
      for (const double lane_m : {-3.6, 0.0, 3.6}) {
        const double radius_m = kRadius_m - side * lane_m;
        const Eigen::Vector2d at(radius_m * std::sin(turned_rad), side * (kRadius_m - radius_m * std::cos(turned_rad)));
        const auto heading_rad = road.heading_rad(at);
        ASSERT_TRUE(heading_rad) << lane_m;
        EXPECT_NEAR(*heading_rad, side * turned_rad, 0.005) << lane_m;
      }
    }
  }
}

TEST(OwnRoad, IsNotKnownBesideItNorFarAroundABendNorAskedForNearby) {
  const OwnRoad straight = driving(20.0, 0.0), bend = driving(12.0, 0.1);
  EXPECT_TRUE(straight.heading_rad({120.0, 7.0}));
  EXPECT_FALSE(straight.heading_rad({120.0, 9.0}));
  EXPECT_TRUE(bend.heading_rad({32.0, 4.0}));
  EXPECT_FALSE(bend.heading_rad({32.0, -7.0})) << "it bends to the left";
  EXPECT_FALSE(bend.heading_rad({50.0, 12.0}));
  EXPECT_TRUE(straight.heading_rad({-30.1, 0.0})) << "behind, too";
  EXPECT_FALSE(straight.heading_rad({29.9, 0.0}));
  EXPECT_FALSE(straight.heading_rad({std::nan(""), 0.0}));
}

TEST(OwnRoad, RunsStraightOnForWhoIsTooSlowToTell) {
  const auto heading_rad = driving(1.0, 0.05).heading_rad({60.0, 0.0});
  ASSERT_TRUE(heading_rad);
  EXPECT_EQ(*heading_rad, 0.0);
}

}  // namespace
}  // namespace boresight::tracking
