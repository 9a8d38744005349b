#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "services/tracker/core/ggiw/component.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

using support::Reference;

constexpr double kRounding = 1e-12;

MotionParameters motion_of(double q, double rate_memory_s, double extent_memory_s) {
  MotionParameters m;
  m.acceleration_density = q;
  m.rate_memory_s = rate_memory_s;
  m.extent_memory_s = extent_memory_s;
  return m;
}

TEST(Prediction, EqualsTheTextbookMatricesOfWhiteAcceleration) {
  support::Random random(1);
  for (int run = 0; run < 500; ++run) {
    Reference expected = support::random_object(random);
    Component<double> c = support::component_of(expected);
    const double t = support::uniform(random, 0.01, 3.0);
    const MotionParameters motion = motion_of(support::uniform(random, 0.0, 5.0), 1.3, 4.0);
    predict(c, motion, t);
    support::predict_reference(expected, motion, t);
    support::expect_equal(support::reference_of(c), expected, kRounding);
  }
}

TEST(Prediction, ProcessNoiseIsTheIntegralOfTheWhiteAcceleration) {
  Component<double> c;
  c.extent_scale = {2.0, 0.0, 2.0};
  constexpr double kDensity = 1.7, kTime_s = 0.8;
  constexpr int kSteps = 100'000;
  predict(c, motion_of(kDensity, 1.0, 1.0), kTime_s);
  // An acceleration at time s moves the place by t − s and the velocity by 1.
  double place = 0.0, both = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double left_s = kTime_s * (i + 0.5) / kSteps;
    place += left_s * left_s * kTime_s / kSteps;
    both += left_s * kTime_s / kSteps;
  }
  EXPECT_NEAR(c.position_covariance.xx, kDensity * place, 1e-9);
  EXPECT_NEAR(c.position_velocity_covariance.yy, kDensity * both, 1e-9);
  EXPECT_NEAR(c.velocity_covariance.xx, kDensity * kTime_s, kRounding);
  EXPECT_EQ(c.position_covariance.xy, 0.0);
}

TEST(Prediction, IsInvertedByARetrodictionWithoutNoise) {
  support::Random random(2);
  for (int run = 0; run < 200; ++run) {
    const Reference before = support::random_object(random);
    Component<double> c = support::component_of(before);
    MotionParameters motion = motion_of(0.0, 1e12, 1e12);
    const double t = support::uniform(random, 0.05, 2.0);
    predict(c, motion, t);
    motion.acceleration_density = 3.0;  // of no effect backwards
    predict(c, motion, -t);
    support::expect_equal(support::reference_of(c), before, 1e-11);
  }
}

TEST(Prediction, InTwoStepsEqualsOneOfTheSameTime) {
  support::Random random(3);
  for (int run = 0; run < 200; ++run) {
    const Component<double> before = support::component_of(support::random_object(random));
    const MotionParameters motion = motion_of(2.0, 1.5, 3.0);
    Component<double> once = before, twice = before;
    predict(once, motion, 0.7);
    predict(twice, motion, 0.2);
    predict(twice, motion, 0.5);
    // Only while the degrees of freedom stay above their bound.
    if (once.extent_dof <= motion.extent_min_dof) continue;
    support::expect_equal(support::reference_of(twice), support::reference_of(once), 1e-11);
  }
}

TEST(Prediction, ByNoTimeChangesNothing) {
  support::Random random(4);
  const Reference before = support::random_object(random);
  Component<double> c = support::component_of(before);
  predict(c, motion_of(2.0, 1.0, 1.0), 0.0);
  support::expect_equal(support::reference_of(c), before, 1e-15);
}

TEST(Forgetting, KeepsTheMeansOfRateAndExtentAndWidensBoth) {
  support::Random random(5);
  for (int run = 0; run < 200; ++run) {
    const Component<double> before = support::component_of(support::random_object(random));
    Component<double> c = before;
    predict(c, motion_of(1.0, 0.8, 2.0), 0.5);
    EXPECT_NEAR(c.rate_shape / c.rate_inverse_scale, before.rate_shape / before.rate_inverse_scale, kRounding * 50.0);
    EXPECT_LT(support::relative_error(support::eigen(extent(c)), support::eigen(extent(before))), kRounding);
    EXPECT_LT(c.rate_shape, before.rate_shape);
    EXPECT_LT(c.extent_dof, before.extent_dof);
  }
}

TEST(Forgetting, StopsAtTheLeastShapeAndDegreesOfFreedom) {
  Component<double> c;
  c.rate_shape = 20.0;
  c.rate_inverse_scale = 4.0;
  c.extent_dof = 30.0;
  c.extent_scale = {48.0, 12.0, 24.0};
  MotionParameters motion = motion_of(1.0, 1.0, 1.0);
  motion.rate_min_shape = 2.0;
  motion.extent_min_dof = 9.0;
  predict(c, motion, 100.0);
  EXPECT_EQ(c.rate_shape, 2.0);
  EXPECT_NEAR(c.rate_inverse_scale, 0.4, kRounding);
  EXPECT_EQ(c.extent_dof, 9.0);
  EXPECT_NEAR(extent(c).xx, 2.0, kRounding);
  EXPECT_NEAR(extent(c).xy, 0.5, kRounding);
  EXPECT_NEAR(extent(c).yy, 1.0, kRounding);
}

TEST(Forgetting, KeepsTheExtentAboveItsLeastEigenvalue) {
  // Far below the measurement noise an extent is not observable, and its update makes it thinner and thinner.
  MotionParameters motion = motion_of(1.0, 1.0, 1.0);
  motion.extent_min_m2 = 0.01;
  const Eigen::Matrix2d turn = support::rotation(0.6);
  Component<double> c;
  c.extent_dof = 20.0;
  c.extent_scale = support::symmetric_of(14.0 * turn * Eigen::Vector2d(4.0, 1e-6).asDiagonal() * turn.transpose());
  predict(c, motion, 0.1);
  const Eigen::Vector2d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(support::eigen(extent(c))).eigenvalues();
  EXPECT_NEAR(eigenvalues(0), 0.01, 1e-9);
  EXPECT_NEAR(eigenvalues(1), 4.01, 1e-3);
}

TEST(Prediction, OfTheRotatedObjectIsTheRotatedPrediction) {
  support::Random random(6);
  for (int run = 0; run < 100; ++run) {
    const Reference object = support::random_object(random);
    const double angle = support::uniform(random, -3.0, 3.0);
    const MotionParameters motion = motion_of(2.0, 1.0, 4.0);
    Component<double> c = support::component_of(object), turned = support::component_of(rotated(object, angle));
    predict(c, motion, 0.6);
    predict(turned, motion, 0.6);
    support::expect_equal(support::reference_of(turned), rotated(support::reference_of(c), angle), 1e-11);
  }
}

// Merging.

struct Mixture {
  std::vector<Component<double>> components;
  std::vector<WeightedComponent<double>> weighted;
};
Mixture random_mixture(support::Random& random, std::size_t n) {
  Mixture m;
  for (std::size_t i = 0; i < n; ++i) m.components.push_back(support::component_of(support::random_object(random)));
  for (const auto& c : m.components) m.weighted.push_back({support::uniform(random, 0.1, 2.0), &c});
  return m;
}

TEST(Merging, KeepsTheMomentsOfTheMixture) {
  support::Random random(7);
  for (int run = 0; run < 200; ++run) {
    const Mixture mixture = random_mixture(random, 2 + static_cast<std::size_t>(run % 4));
    double sum = 0.0, rate = 0.0, rate_squares = 0.0, dof = 0.0;
    Eigen::Vector4d mean = Eigen::Vector4d::Zero();
    Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
    Eigen::Matrix2d extents = Eigen::Matrix2d::Zero();
    for (const auto& w : mixture.weighted) sum += w.weight;
    for (const auto& w : mixture.weighted) {
      const Reference r = support::reference_of(*w.component);
      const double p = w.weight / sum, mean_rate = r.rate_shape / r.rate_inverse_scale;
      mean += p * r.mean;
      squares += p * (r.covariance + r.mean * r.mean.transpose());
      extents += p * r.extent();
      dof += p * r.dof;
      rate += p * mean_rate;
      rate_squares += p * (mean_rate * mean_rate + r.rate_shape / (r.rate_inverse_scale * r.rate_inverse_scale));
    }
    const Reference merged = support::reference_of(merge<double>(mixture.weighted));
    EXPECT_LT(support::relative_error(merged.mean, mean), kRounding);
    EXPECT_LT(support::relative_error(merged.covariance, (squares - mean * mean.transpose()).eval()), 1e-10);
    EXPECT_LT(support::relative_error(merged.extent(), extents), kRounding);
    EXPECT_NEAR(merged.dof, dof, 1e-10);
    EXPECT_NEAR(merged.rate_shape / merged.rate_inverse_scale, rate, 1e-10);
    EXPECT_NEAR(merged.rate_shape / std::pow(merged.rate_inverse_scale, 2), rate_squares - rate * rate, 1e-9);
  }
}

TEST(Merging, OfEqualComponentsIsTheComponent) {
  support::Random random(8);
  const Component<double> c = support::component_of(support::random_object(random));
  const std::array<WeightedComponent<double>, 3> three{{{0.2, &c}, {3.0, &c}, {1.0, &c}}};
  support::expect_equal(support::reference_of(merge<double>(three)), support::reference_of(c), 1e-9);
}

TEST(Merging, TakesTheMeanOfSourcesAndNoRadarWhereTheyDiffer) {
  Component<double> a, b;
  a.extent_scale = b.extent_scale = {2.0, 0.0, 2.0};
  a.source = {0.8, 0.1, 0.05, 2};
  b.source = {0.2, 0.3, 0.25, 2};
  a.mirror = 0.4;
  std::array<WeightedComponent<double>, 2> two{{{3.0, &a}, {1.0, &b}}};
  const Component<double> same = merge<double>(two);
  EXPECT_NEAR(same.source.object, 0.65, kRounding);
  EXPECT_NEAR(same.source.side_lobe, 0.15, kRounding);
  EXPECT_NEAR(same.source.lasting_source, 0.1, kRounding);
  EXPECT_NEAR(same.source.brief_source(), 0.1, kRounding);
  EXPECT_NEAR(same.mirror, 0.3, kRounding);
  EXPECT_EQ(same.source.radar, 2);
  b.source.radar = 0;
  EXPECT_EQ(merge<double>(two).source.radar, -1);
}

TEST(Distance, IsZeroOfEqualsSymmetricAndGrowsWithEachPart) {
  support::Random random(9);
  for (int run = 0; run < 100; ++run) {
    const Component<double> a = support::component_of(support::random_object(random));
    Component<double> b = support::component_of(support::random_object(random));
    EXPECT_EQ(distance(a, a), 0.0);
    EXPECT_NEAR(distance(a, b), distance(b, a), 1e-9 * distance(a, b));
    b = a;
    b.position_m.x += 1.0;
    const double moved = distance(a, b);
    EXPECT_NEAR(moved, inverse(a.position_covariance).xx, 1e-9 * moved) << "half the sum of both squared distances";
    b = a;
    b.velocity_mps.y += 1.0;
    EXPECT_NEAR(distance(a, b), 0.5 * inverse(a.velocity_covariance).yy, 1e-9);
    b = a;
    b.extent_scale = 1.5 * b.extent_scale;
    EXPECT_GT(distance(a, b), 0.0);
    b = a;
    b.rate_shape *= 2.0;
    b.rate_inverse_scale *= 2.0;
    EXPECT_NEAR(distance(a, b), 0.0, kRounding) << "the same mean rate";
    b.rate_shape *= 2.0;
    EXPECT_GT(distance(a, b), 0.1);
  }
}

TEST(Distance, DoesNotDependOnTheAxes) {
  support::Random random(10);
  for (int run = 0; run < 100; ++run) {
    const Reference a = support::random_object(random), b = support::random_object(random);
    const double before = distance(support::component_of(a), support::component_of(b));
    const double after = distance(support::component_of(rotated(a, 0.7)), support::component_of(rotated(b, 0.7)));
    EXPECT_NEAR(after, before, 1e-9 * before);
  }
}

}  // namespace
}  // namespace boresight::tracking
