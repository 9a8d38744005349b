// The steps of the gradient methods against the printed equations on explicit matrices.
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/published/least_squares.hpp"
#include "services/alignment_estimator/core/published/steepest_descent.hpp"
#include "services/alignment_estimator/core/published/total_least_squares.hpp"

namespace boresight::alignment::published {
namespace {

struct Rows {
  Eigen::MatrixXd j = Eigen::MatrixXd(50, 4);
  Eigen::VectorXd r = Eigen::VectorXd(50);
  NormalEquations equations;

  explicit Rows(int parameters = 4) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0.0, 1.0);
    const double scale[] = {10.0, 7.0, 1.0, 3.0};
    for (int i = 0; i < 50; ++i) {
      for (int p = 0; p < 4; ++p) j(i, p) = p < parameters ? scale[p] * normal(random) : 0.0;
      r(i) = 0.2 * normal(random) + 0.01 * j(i, 0) - 0.02 * j(i, 2);
      equations.add(j.row(i).transpose(), r(i));
    }
  }
};

TEST(Steps, SteepestDescentIsEquation23) {
  const Rows rows;
  const Eigen::Vector4d rate(1e-6, 1e-3, 1e-2, 1e-2);
  const Eigen::Vector4d expected = -(rate.array() * (rows.j.transpose() * rows.r).array() / 50.0).matrix();
  EXPECT_TRUE(steepest_descent_step(rows.equations, rate).isApprox(expected, 1e-12));
  EXPECT_EQ(steepest_descent_step({}, rate), Eigen::Vector4d::Zero());
}

TEST(Steps, LeastSquaresIsEquation24) {
  const Rows rows;
  const Eigen::Vector4d rate(1e-3, 1e-2, 1e-2, 1e-2);
  const Eigen::Vector4d inverse =
      (rows.j.transpose() * rows.j + 10.0 * Eigen::Matrix4d::Identity()).inverse() * rows.j.transpose() * rows.r;
  EXPECT_TRUE(
      least_squares_step(rows.equations, 10.0, rate).isApprox(-(rate.array() * inverse.array()).matrix(), 1e-9));
}

TEST(Steps, LeastSquaresDoesNotMoveParametersWithoutGradient) {
  const Rows rows(2);
  const Eigen::Vector4d step = least_squares_step(rows.equations, 10.0, Eigen::Vector4d::Ones());
  EXPECT_NE(step(0), 0.0);
  EXPECT_EQ(step(2), 0.0);
  EXPECT_EQ(step(3), 0.0);
}

/// (26)(27) by the singular vectors of the matrix itself.
Eigen::VectorXd by_svd(const Rows& rows, int parameters, double rate) {
  Eigen::MatrixXd a(50, parameters + 1);
  a << rows.j.leftCols(parameters), rate * rows.r;
  const Eigen::MatrixXd v = Eigen::JacobiSVD<Eigen::MatrixXd>(a, Eigen::ComputeThinV).matrixV();
  return v.col(parameters).head(parameters) / v(parameters, parameters);
}

TEST(Steps, TotalLeastSquaresIsEquation27) {
  for (const double rate : {2e-4, 1e-2, 1.0}) {
    for (const int parameters : {2, 4}) {
      const Rows rows(parameters);
      const Eigen::Vector4d step = total_least_squares_step(rows.equations, parameters, rate);
      EXPECT_LT((step.head(parameters) - by_svd(rows, parameters, rate)).norm(), 1e-6 * step.norm())
          << rate << ' ' << parameters;
    }
  }
}

TEST(Steps, TotalLeastSquaresWithASmallRateIsADampedLeastSquaresStep) {
  const Rows rows;
  const Eigen::Vector4d full = (rows.j.transpose() * rows.j).inverse() * rows.j.transpose() * rows.r;
  EXPECT_TRUE(total_least_squares_step(rows.equations, 4, 2e-4).isApprox(-2e-4 * full, 1e-4));
}

TEST(Steps, TotalLeastSquaresWithoutSolutionTakesNoStep) {
  const Rows rows(2);  // no gradient of β and γ: the smallest singular vector lies there
  EXPECT_EQ(total_least_squares_step(rows.equations, 4, 2e-4), Eigen::Vector4d::Zero());
  NormalEquations broken;
  broken.jtj.setConstant(std::nan(""));
  EXPECT_EQ(total_least_squares_step(broken, 4, 2e-4), Eigen::Vector4d::Zero());
}

}  // namespace
}  // namespace boresight::alignment::published
