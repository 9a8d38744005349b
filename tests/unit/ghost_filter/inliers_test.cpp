#include "services/ghost_filter/core/reflector_map/inliers.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

TEST(Inliers, AreThoseThatTheirDistanceMakesInliers) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-15.0, 15.0), near(-1.0, 1.0), bend(-0.05, 0.05), angle(-M_PI, M_PI);
  Inliers<64> inliers;
  std::size_t sum = 0;
  for (int round = 0; round < 2000; ++round) {
    // Also far from where the frame began.
    const Eigen::Vector2d middle = (round % 3 == 0 ? 0.0 : 30000.0) * Eigen::Vector2d(near(random), near(random));
    const double heading = angle(random);
    const Curve curve{middle + Eigen::Vector2d(place(random), place(random)),
                      {std::cos(heading), std::sin(heading)},
                      round % 5 == 0 ? 0.0 : bend(random)};
    std::vector<Eigen::Vector2d> points;
    std::size_t expected = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(round % 65); ++i) {
      const Eigen::Vector2d p = i % 2 == 0 ? Eigen::Vector2d(middle + Eigen::Vector2d(place(random), place(random)))
                                           : Eigen::Vector2d(curve.at(place(random)) + near(random) * curve.normal());
      const double distance = std::abs(curve.distance(p));
      if (std::abs(distance - 0.3) < 1e-6) continue;
      expected += distance < 0.3 ? 1 : 0;
      points.push_back(p);
    }
    inliers.set(points);
    ASSERT_EQ(inliers.count(curve, 0.3), expected) << "round " << round;
    sum += expected;
  }
  EXPECT_GT(sum, 5000U);
}

TEST(Inliers, OfNothingAndOfMoreThanThereIsRoomFor) {
  Inliers<4> inliers;
  const Curve curve{{0.0, 0.0}, {1.0, 0.0}, 0.0};
  EXPECT_EQ(inliers.count(curve, 0.3), 0U);
  const std::vector<Eigen::Vector2d> many(9, Eigen::Vector2d(3.0, 0.1));
  inliers.set(many);
  EXPECT_EQ(inliers.count(curve, 0.3), 4U);
  inliers.set({});
  EXPECT_EQ(inliers.count(curve, 0.3), 0U);
}

}  // namespace
}  // namespace boresight::ghosts
