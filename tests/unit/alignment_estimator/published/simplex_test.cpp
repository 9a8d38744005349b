// The simplex on functions whose minimum is known, without any radar.
#include "services/alignment_estimator/core/published/simplex.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight::alignment::published {
namespace {

using Point = Eigen::Vector4d;

TEST(Simplex, FindsTheMinimumOfRosenbrocksValley) {
  const auto valley = [](const Point& x) { return std::pow(1.0 - x(0), 2) + 100.0 * std::pow(x(1) - x(0) * x(0), 2); };
  const Point start(-1.2, 1.0, 5.0, 7.0);
  Simplex simplex(start, Point(0.5, 0.5, 0.5, 0.5), 2, valley);
  double before = simplex.best_cost();
  for (int i = 0; i < 200; ++i) {
    simplex.iterate(valley);
    ASSERT_LE(simplex.best_cost(), before);
    before = simplex.best_cost();
  }
  EXPECT_NEAR(simplex.best()(0), 1.0, 1e-5);
  EXPECT_NEAR(simplex.best()(1), 1.0, 1e-5);
  EXPECT_EQ(simplex.best()(2), 5.0);  // beyond its dimensions
  EXPECT_EQ(simplex.best()(3), 7.0);
}

TEST(Simplex, FindsTheMinimumOfACorrelatedBowlInFourDimensions) {
  Eigen::Matrix4d a;
  a << 4, 1, 0, 0, 1, 3, 1, 0, 0, 1, 2, 0.5, 0, 0, 0.5, 1;
  const Point minimum(0.3, -0.2, 0.1, 0.5);
  int calls = 0;
  const auto bowl = [&](const Point& x) {
    ++calls;
    return (x - minimum).dot(a * (x - minimum));
  };
  Simplex simplex(Point::Zero(), Point::Constant(0.1), 4, bowl);
  EXPECT_EQ(calls, 5);
  for (int i = 0; i < 300; ++i) simplex.iterate(bowl);
  EXPECT_LT((simplex.best() - minimum).norm(), 1e-6);
}

TEST(Simplex, OneIterationCostsTwoEvaluationsOrAShrinkage) {
  int calls = 0;
  const auto slope = [&](const Point& x) {
    ++calls;
    return x(0);
  };
  Simplex simplex(Point::Zero(), Point::Constant(1.0), 4, slope);
  calls = 0;
  simplex.iterate(slope);
  EXPECT_EQ(calls, 2);  // reflection is better than all, expansion is tried
}

TEST(Simplex, RanksACostThatIsNotANumberLast) {
  const auto wall = [](const Point& x) { return x(0) > 0.4 ? std::nan("") : (x - Point::Constant(0.3)).squaredNorm(); };
  Simplex simplex(Point::Zero(), Point::Constant(0.5), 4, wall);
  for (int i = 0; i < 300; ++i) simplex.iterate(wall);
  EXPECT_LT((simplex.best() - Point::Constant(0.3)).norm(), 1e-5);
}

}  // namespace
}  // namespace boresight::alignment::published
