#include <gtest/gtest.h>

#include "services/tracker/core/ggiw/planar.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

constexpr int kRandomMatrices = 2000;

Symmetric2<double> random_symmetric(support::Random& random) {
  return {support::normal(random), support::normal(random), support::normal(random)};
}
Matrix2<double> random_matrix(support::Random& random) {
  return {support::normal(random), support::normal(random), support::normal(random), support::normal(random)};
}
Vector2<double> random_vector(support::Random& random) {
  return {support::normal(random), support::normal(random)};
}

TEST(PlanarAlgebra, EqualsEigenInSumsAndMultiples) {
  support::Random random(1);
  for (int run = 0; run < kRandomMatrices; ++run) {
    const auto a = random_vector(random), b = random_vector(random);
    const auto s = random_symmetric(random), t = random_symmetric(random);
    const auto m = random_matrix(random), n = random_matrix(random);
    const double f = support::normal(random);
    EXPECT_EQ(support::eigen(a + b), support::eigen(a) + support::eigen(b));
    EXPECT_EQ(support::eigen(a - b), support::eigen(a) - support::eigen(b));
    EXPECT_EQ(support::eigen(f * a), f * support::eigen(a));
    EXPECT_EQ(support::eigen(s + t), support::eigen(s) + support::eigen(t));
    EXPECT_EQ(support::eigen(s - t), support::eigen(s) - support::eigen(t));
    EXPECT_EQ(support::eigen(f * s), f * support::eigen(s));
    EXPECT_EQ(support::eigen(m + n), support::eigen(m) + support::eigen(n));
    EXPECT_EQ(support::eigen(m - n), support::eigen(m) - support::eigen(n));
    EXPECT_EQ(support::eigen(f * m), f * support::eigen(m));
    EXPECT_EQ(support::eigen(transpose(m)), support::eigen(m).transpose());
    EXPECT_EQ(support::eigen(full(s)), support::eigen(s));
  }
}

TEST(PlanarAlgebra, EqualsEigenInProducts) {
  support::Random random(2);
  constexpr double kRounding = 1e-14;
  for (int run = 0; run < kRandomMatrices; ++run) {
    const auto a = random_vector(random), b = random_vector(random);
    const auto s = random_symmetric(random), t = random_symmetric(random);
    const auto m = random_matrix(random), n = random_matrix(random);
    const Eigen::Vector2d ea = support::eigen(a), eb = support::eigen(b);
    const Eigen::Matrix2d es = support::eigen(s), et = support::eigen(t), em = support::eigen(m),
                          en = support::eigen(n);
    EXPECT_NEAR(dot(a, b), ea.dot(eb), kRounding);
    EXPECT_NEAR(squared_norm(a), ea.squaredNorm(), kRounding);
    EXPECT_NEAR(quadratic(s, a), ea.dot(es * ea), 4.0 * kRounding);
    EXPECT_NEAR(trace(s), es.trace(), kRounding);
    EXPECT_NEAR(determinant(s), es.determinant(), kRounding);
    EXPECT_NEAR(determinant(m), em.determinant(), kRounding);
    EXPECT_LT((support::eigen(outer(a)) - ea * ea.transpose()).norm(), kRounding);
    EXPECT_LT((support::eigen(outer(a, b)) - ea * eb.transpose()).norm(), kRounding);
    EXPECT_LT((support::eigen(s * a) - es * ea).norm(), kRounding);
    EXPECT_LT((support::eigen(m * a) - em * ea).norm(), kRounding);
    EXPECT_LT((support::eigen(m * n) - em * en).norm(), kRounding);
    EXPECT_LT((support::eigen(s * t) - es * et).norm(), kRounding);
    EXPECT_LT((support::eigen(m * s) - em * es).norm(), kRounding);
    EXPECT_LT((support::eigen(congruent(m, s)) - em * es * em.transpose()).norm(), 10.0 * kRounding);
  }
}

TEST(PlanarAlgebra, EqualsEigenInInverseAndRoot) {
  support::Random random(3);
  for (int run = 0; run < kRandomMatrices; ++run) {
    const Eigen::Matrix2d expected = support::random_positive<2>(random, 2.0);
    const auto s = support::symmetric_of(expected);
    EXPECT_LT(support::relative_error(support::eigen(inverse(s)), expected.inverse()), 1e-12);
    EXPECT_LT(support::relative_error(support::eigen(square_root(s)), support::symmetric_root(expected)), 1e-12);
  }
}

TEST(PlanarAlgebra, RootOfAMultipleOfTheIdentityIsExact) {
  const Symmetric2<double> root = square_root(Symmetric2<double>{9.0, 0.0, 9.0});
  EXPECT_EQ(root.xx, 3.0);
  EXPECT_EQ(root.xy, 0.0);
  EXPECT_EQ(root.yy, 3.0);
}

TEST(PlanarAlgebra, RootOfALongThinMatrixSquaresToIt) {
  support::Random random(4);
  for (const double ratio : {1e3, 1e6, 1e9}) {
    for (int run = 0; run < 100; ++run) {
      const Eigen::Matrix2d turn = support::rotation(support::uniform(random, -3.0, 3.0));
      const Eigen::Matrix2d thin = turn * Eigen::Vector2d(ratio, 1.0).asDiagonal() * turn.transpose();
      const Eigen::Matrix2d root = support::eigen(square_root(support::symmetric_of(thin)));
      EXPECT_LT(support::relative_error((root * root).eval(), thin), 1e-12) << ratio;
    }
  }
}

TEST(PlanarAlgebra, InSinglePrecisionEqualsEigenToItsRounding) {
  support::Random random(5);
  for (int run = 0; run < kRandomMatrices; ++run) {
    const Eigen::Matrix2d a = support::random_positive<2>(random, 2.0);
    const Symmetric2<float> s{static_cast<float>(a(0, 0)), static_cast<float>(a(0, 1)), static_cast<float>(a(1, 1))};
    const Eigen::Matrix2d expected = support::eigen(s);
    EXPECT_LT(support::relative_error(support::eigen(square_root(s)), support::symmetric_root(expected)), 1e-5);
    EXPECT_LT(support::relative_error(support::eigen(inverse(s)), expected.inverse()), 1e-4);
  }
}

}  // namespace
}  // namespace boresight::tracking
