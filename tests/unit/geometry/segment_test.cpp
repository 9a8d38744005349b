#include "services/common/geometry/segment.hpp"

#include <random>

#include <gtest/gtest.h>

namespace boresight::geometry {
namespace {

TEST(Crossing, IsTheShareOfTheFirstSegment) {
  const auto share = crossing({0.0, 0.0}, {10.0, 0.0}, {4.0, -1.0}, {4.0, 3.0});
  ASSERT_TRUE(share);
  EXPECT_DOUBLE_EQ(*share, 0.4);
  EXPECT_FALSE(crossing({0.0, 0.0}, {3.9, 0.0}, {4.0, -1.0}, {4.0, 3.0})) << "too short";
  EXPECT_FALSE(crossing({0.0, 0.0}, {10.0, 0.0}, {4.0, 1.0}, {4.0, 3.0})) << "passes beside it";
  EXPECT_FALSE(crossing({0.0, 0.0}, {10.0, 0.0}, {0.0, 1.0}, {10.0, 1.0})) << "parallel";
  EXPECT_FALSE(crossing({0.0, 0.0}, {0.0, 0.0}, {4.0, 1.0}, {4.0, 3.0})) << "no length";
}

TEST(Crossing, TheCrossingLiesOnBothSegments) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-10.0, 10.0);
  const auto point = [&] { return Eigen::Vector2d(place(random), place(random)); };
  int crossed = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Eigen::Vector2d a = point(), b = point(), c = point(), d = point();
    const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
      return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    };
    const bool expected = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
    const auto share = crossing(a, b, c, d);
    ASSERT_EQ(share.has_value(), expected);
    if (!share) continue;
    ++crossed;
    EXPECT_NEAR(side(c, d, a + *share * (b - a)), 0.0, 1e-6);
  }
  EXPECT_GT(crossed, 1000);
}

TEST(Ellipse, RayAndContainmentAgree) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-20.0, 20.0), angle(-3.0, 3.0), size(0.3, 5.0);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ellipse ellipse{{place(random), place(random)}, angle(random), size(random), size(random)};
    const double a = angle(random);
    const Eigen::Vector2d origin(place(random), place(random)), along(std::cos(a), std::sin(a));
    const auto stretch = stretch_within(ellipse, origin, along);
    bool touched = false;
    for (double t = 0.005; t < 80.0; t += 0.01) {
      const bool inside = contains(ellipse, origin + t * along);
      touched = touched || inside;
      if (!stretch) continue;
      const bool expected = t > stretch->enter_m && t < stretch->leave_m;
      const double to_edge = std::min(std::abs(t - stretch->enter_m), std::abs(t - stretch->leave_m));
      if (to_edge > 1e-6) {
        ASSERT_EQ(inside, expected) << i << " at " << t;
      }
    }
    if (touched) {
      EXPECT_TRUE(stretch.has_value());
    }
    hits += stretch ? 1 : 0;
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace boresight::geometry
