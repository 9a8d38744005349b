// The kernels of square-root filters beside Eigen's decompositions, and where they refuse.
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "services/tracker/core/filters/flat_arctangent.hpp"
#include "services/tracker/core/filters/square_root.hpp"
#include "tests/unit/tracker/filters_support.hpp"

namespace boresight::tracking::filters {
namespace {

using testing::Matrix6;
using testing::Vector6;

Matrix6 random_covariance(unsigned seed) {
  std::srand(seed);
  const Matrix6 any = Matrix6::Random();
  return any * any.transpose() + 0.1 * Matrix6::Identity();
}

TEST(SquareRootKernels, CholeskyIsThatOfEigen) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Matrix6 covariance = random_covariance(seed);
    Matrix6 root;
    ASSERT_TRUE(cholesky(covariance, root));
    const Matrix6 expected = covariance.llt().matrixL();
    EXPECT_LT((root - expected).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(SquareRootKernels, QrRootIsTheCholeskyRootOfTheSquare) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::srand(seed);
    Matrix<double, 18, 6> rows = Matrix<double, 18, 6>::Random();
    if (seed % 3 == 0) rows.topRows<4>().setZero();
    const Matrix6 expected = Matrix6(rows.transpose() * rows).llt().matrixL();
    Matrix6 root;
    qr_root(rows, root);
    EXPECT_LT((root - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(SquareRootKernels, QrRootOfRowsWithoutRankIsARootToo) {
  Matrix<double, 6, 3> rows = Matrix<double, 6, 3>::Zero();
  rows.col(1).setOnes();
  Matrix<double, 3, 3> root;
  const Matrix<double, 3, 3> expected = rows.transpose() * rows;
  qr_root(rows, root);
  EXPECT_LT((root * root.transpose() - expected).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(root(0, 0), 0.0);
  EXPECT_EQ(root(2, 2), 0.0);
}

TEST(SquareRootKernels, RankOneUpdateIsTheRootOfTheChangedSquare) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Matrix6 covariance = random_covariance(seed);
    const Vector6 vector = 0.3 * Vector6::Random();
    for (const double weight : {2.0, 0.5, -0.01}) {
      Matrix6 root = covariance.llt().matrixL();
      const Matrix6 expected = Matrix6(covariance + weight * vector * vector.transpose()).llt().matrixL();
      ASSERT_TRUE((rank_one_update<double, 6>(root, vector, weight)));
      EXPECT_LT((root - expected).cwiseAbs().maxCoeff(), 1e-12) << weight;
    }
  }
}

TEST(SquareRootKernels, RefuseWhatIsNotPositiveDefinite) {
  Matrix6 root;
  Matrix6 indefinite = Matrix6::Identity();
  indefinite(3, 2) = 1.5;
  EXPECT_FALSE(cholesky(indefinite, root));
  EXPECT_FALSE(cholesky(Matrix6(Matrix6::Zero()), root));
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Matrix6 broken = Matrix6::Identity();
    broken(4, 4) = value;
    EXPECT_FALSE(cholesky(broken, root)) << value;
    root.setIdentity();
    EXPECT_FALSE((rank_one_update<double, 6>(root, Vector6::Constant(value), 1.0))) << value;
  }
  root.setIdentity();
  EXPECT_FALSE((rank_one_update<double, 6>(root, Vector6::UnitX(), -1.0)));
}

TEST(FlatArctangent, IsTheArctangentToRounding) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  double worst = 0.0, worst_float = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    const double y = uniform(random) * std::pow(10.0, 4.0 * uniform(random)), x = uniform(random);
    worst = std::max(worst, std::abs(flat_arctangent(y, x) - std::atan2(y, x)));
    const auto fy = static_cast<float>(y), fx = static_cast<float>(x);
    worst_float = std::max<double>(worst_float, std::abs(flat_arctangent(fy, fx) - std::atan2(fy, fx)));
  }
  EXPECT_LT(worst, 4.0 * std::numeric_limits<double>::epsilon());
  EXPECT_LT(worst_float, 4.0 * std::numeric_limits<float>::epsilon());
  // Along the axes.
  EXPECT_EQ(flat_arctangent(0.0, 2.0), 0.0);
  EXPECT_DOUBLE_EQ(flat_arctangent(0.0, -2.0), M_PI);
  EXPECT_DOUBLE_EQ(flat_arctangent(3.0, 0.0), M_PI_2);
  EXPECT_DOUBLE_EQ(flat_arctangent(-3.0, 0.0), -M_PI_2);
}

}  // namespace
}  // namespace boresight::tracking::filters
