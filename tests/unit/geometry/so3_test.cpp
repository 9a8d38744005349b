#include "services/common/geometry/so3.hpp"

#include <gtest/gtest.h>

namespace boresight::geometry {
namespace {

const Eigen::Vector3d kTurns[] = {{0.0, 0.0, 0.0},  {1e-9, -2e-9, 3e-9}, {0.01, -0.02, 0.03},
                                  {0.3, 1.2, -0.7}, {-2.0, 1.0, 1.5},    {0.0, 3.1, 0.0}};

const Eigen::Vector3d kMountings[] = {{0.5, -0.2, 0.1}, {-2.4, 0.03, M_PI - 0.01}, {0.0, 1.2, -0.4}};

TEST(So3, ExponentialIsARotationAndTheLogarithmUndoesIt) {
  for (const Eigen::Vector3d& turn : kTurns) {
    const Eigen::Matrix3d r = so3_exp(turn);
    EXPECT_TRUE((r * r.transpose()).isIdentity(1e-12)) << turn.transpose();
    EXPECT_NEAR(r.determinant(), 1.0, 1e-12);
    EXPECT_TRUE(so3_log(r).isApprox(turn, 1e-9) || (so3_log(r) - turn).norm() < 1e-15) << turn.transpose();
  }
}

TEST(So3, EulerAnglesUndoTheMountingRotation) {
  for (const Eigen::Vector3d& angles : kMountings) {
    EXPECT_TRUE(euler_angles(sensor_to_vehicle(angles(0), angles(1), angles(2))).isApprox(angles, 1e-12))
        << angles.transpose();
  }
}

TEST(So3, EulerGradientIsThatOfFiniteDifferences) {
  const Eigen::Vector3d angles(2.1, 0.3, -0.2);
  const Eigen::Matrix3d r = sensor_to_vehicle(angles(0), angles(1), angles(2));
  const Eigen::Matrix3d gradient = euler_gradient(angles(0), angles(1));
  constexpr double kStep = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d turn = kStep * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d change = (euler_angles(so3_exp(turn) * r) - euler_angles(so3_exp(-turn) * r)) / (2.0 * kStep);
    EXPECT_TRUE(change.isApprox(gradient.col(axis), 1e-8) || (change - gradient.col(axis)).norm() < 1e-8) << axis;
  }
}

TEST(So3, FixedAxesAnglesAreThoseOfTurnsOneAfterTheOther) {
  const Eigen::Vector3d angles(0.4, -0.3, 0.2);
  const Eigen::Matrix3d c =
      so3_exp({angles(2), 0.0, 0.0}) * so3_exp({0.0, -angles(1), 0.0}) * so3_exp({0.0, 0.0, angles(0)});
  EXPECT_TRUE(fixed_axes_rotation(angles(0), angles(1), angles(2)).isApprox(c, 1e-12));
  EXPECT_TRUE(fixed_axes_angles(c).isApprox(angles, 1e-12));
  const Eigen::Vector3d rolled = fixed_axes_angles(so3_exp({0.5, 0.0, 0.0}) * c);
  EXPECT_TRUE(rolled.isApprox(angles + Eigen::Vector3d(0.0, 0.0, 0.5), 1e-12)) << rolled.transpose();
}

TEST(So3, FixedAxesGradientIsThatOfFiniteDifferences) {
  const Eigen::Vector3d angles(0.4, -0.3, 0.2);
  const Eigen::Matrix3d c =
      so3_exp({angles(2), 0.0, 0.0}) * so3_exp({0.0, -angles(1), 0.0}) * so3_exp({0.0, 0.0, angles(0)});
  const Eigen::Matrix3d gradient = fixed_axes_gradient(angles(1), angles(2));
  constexpr double kStep = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d turn = kStep * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d change =
        (fixed_axes_angles(so3_exp(turn) * c) - fixed_axes_angles(so3_exp(-turn) * c)) / (2.0 * kStep);
    EXPECT_LT((change - gradient.col(axis)).norm(), 1e-8) << axis;
  }
}

TEST(So3, StraightUpHasNoRollOfItsOwn) {
  const Eigen::Matrix3d r = sensor_to_vehicle(0.4, M_PI / 2, 0.0);
  const Eigen::Vector3d angles = euler_angles(r);
  EXPECT_EQ(angles(2), 0.0);
  EXPECT_TRUE(sensor_to_vehicle(angles(0), angles(1), angles(2)).isApprox(r, 1e-7));
}

}  // namespace
}  // namespace boresight::geometry
