// Which tracked object a detection is of.
#include "services/tracker/core/owners.hpp"

#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace boresight::tracking {
namespace {

/// A car that drives ahead, far away, where azimuths are known to a metre.
KnownPlace car_at(double x_m, double y_m, double speed_mps) {
  KnownPlace car{{x_m, y_m}, {1.0, 0.0}, {2.25, 0.9}, false, {speed_mps, 0.0}};
  car.position_covariance_m2 = 0.04 * Eigen::Matrix2d::Identity();
  car.velocity_covariance = 0.01 * Eigen::Matrix2d::Identity();
  return car;
}

Seen seen_at(double x_m, double y_m, double rate_mps, double across_std_m = 1.0) {
  return {{x_m, y_m}, {1.0, 0.0}, 0.15, across_std_m, rate_mps, 0.05};
}

constexpr std::size_t kLeft = 0, kRight = 1, kNobody = 2;
const std::array<KnownPlace, 2> kJam{car_at(100.0, 3.6, 2.0), car_at(100.0, 0.0, 1.5)};

TEST(Owner, IsWhoMovesSoWhereThePlaceDoesNotTell) {
  // A bit nearer to the other one's lane, and still within the noise.
  EXPECT_EQ(owner_of(seen_at(97.8, 1.5, 2.0), kJam), kLeft);
  EXPECT_EQ(owner_of(seen_at(97.8, 2.1, 1.5), kJam), kRight);
  // As far from both speeds: the nearer one.
  EXPECT_EQ(owner_of(seen_at(97.8, 2.1, 1.75), kJam), kLeft);
  EXPECT_EQ(owner_of(seen_at(97.8, 1.5, 1.75), kJam), kRight);
}

TEST(Owner, IsWhoIsThereWhereThePlaceTells) {
  EXPECT_EQ(owner_of(seen_at(97.8, 3.6, 1.5, 0.2), kJam), kLeft) << "a wheel";
  EXPECT_EQ(owner_of(seen_at(97.8, 0.0, 2.0, 0.2), kJam), kRight) << "a wheel";
}

TEST(Owner, IsNobodyOfWhatLiesTooFarOff) {
  EXPECT_EQ(owner_of(seen_at(97.8, -6.0, 1.5), kJam), kNobody) << "beyond any part of a vehicle";
  EXPECT_EQ(owner_of(seen_at(95.5, 0.0, 1.5), kJam), kNobody) << "ranges are known well";
  EXPECT_EQ(owner_of(seen_at(97.8, 1.5, 1.5, 0.05), kJam), kRight);
  EXPECT_EQ(owner_of(seen_at(97.8, 2.0, 1.5, 0.05), {&kJam[1], 1}), 1u) << "so are azimuths nearby";
  EXPECT_EQ(owner_of({{97.8, std::nan("")}, {1.0, 0.0}, 0.15, 1.0, 1.5, 0.05}, kJam), kNobody);
  EXPECT_EQ(owner_of(seen_at(97.8, 0.0, 1.5), {}), 0u);
}

TEST(Owner, IsNobodyOfWhatIsBesideTheOnlyOneKnown) {
  const std::array<KnownPlace, 1> truck{car_at(100.0, -3.6, 1.2)};
  EXPECT_EQ(owner_of(seen_at(97.8, -0.8, 1.5), truck), 1u) << "the own lane's car";
  EXPECT_EQ(owner_of(seen_at(97.8, -0.8, 1.2), truck), 0u) << "noise of its own";
  EXPECT_EQ(owner_of(seen_at(97.8, -2.6, 1.5), truck), 0u) << "a wheel";
}

TEST(Beside, IsWhatIsFartherOffThanVehiclesAreWideAndMovesOtherwise) {
  const KnownPlace& car = kJam[kLeft];
  // Its middle line is at 3.6 m; half of 2.6 m, a bit for what is rough, and a standard deviation of 1.02 m.
  EXPECT_TRUE(is_beside(seen_at(97.8, 0.9, 1.5), car));
  EXPECT_TRUE(is_beside(seen_at(97.8, 6.3, 1.5), car));
  EXPECT_FALSE(is_beside(seen_at(97.8, 1.1, 1.5), car)) << "within the noise";
  EXPECT_TRUE(is_beside(seen_at(97.8, 1.1, 1.5, 0.5), car)) << "azimuths that are known better";
  EXPECT_FALSE(is_beside(seen_at(97.8, 0.9, 1.9), car)) << "moves as it does";
  EXPECT_FALSE(is_beside(seen_at(110.0, 3.6, 1.5), car)) << "ahead";
  KnownPlace drawn = car;
  drawn.half_m.y() = 3.0;
  EXPECT_TRUE(is_beside(seen_at(97.8, 0.9, 1.5), drawn)) << "a box that is wider than any vehicle";
  EXPECT_FALSE(is_beside({{97.8, std::nan("")}, {1.0, 0.0}, 0.15, 1.0, 1.5, 0.05}, car));
}

TEST(Owner, IsTheSameInAnyOtherAxes) {
  const Eigen::Rotation2Dd turn(0.9);
  std::array<KnownPlace, 2> turned = kJam;
  for (KnownPlace& car : turned) {
    car.position_m = turn * car.position_m;
    car.axis = turn * car.axis;
    car.velocity_mps = turn * car.velocity_mps;
  }
  for (double y_m = -6.0; y_m < 10.0; y_m += 0.1) {
    for (const double rate_mps : {0.0, 1.5, 1.7, 2.0, 5.0}) {
      const Seen seen = seen_at(97.8, y_m, rate_mps);
      Seen other = seen;
      other.at_m = turn * seen.at_m;
      other.sight = turn * seen.sight;
      EXPECT_EQ(owner_of(seen, kJam), owner_of(other, turned)) << y_m << " m, " << rate_mps << " m/s";
      EXPECT_EQ(is_beside(seen, kJam[kLeft]), is_beside(other, turned[kLeft])) << y_m << " m, " << rate_mps << " m/s";
    }
  }
}

TEST(Owner, IsThePersonWithinReachBeforeAnyVehicle) {
  const Eigen::Vector2d walks(1.2, 0.0);
  const std::array<KnownPlace, 2> both{{car_at(14.0, 0.0, 5.5), {{12.0, -1.9}, {1.0, 0.0}, {0.5, 0.3}, true, walks}}};
  EXPECT_EQ(owner_of(seen_at(11.9, -1.2, 1.2, 0.1), both), 1u);
  EXPECT_EQ(owner_of(seen_at(11.7, -0.8, 5.5, 0.1), both), 0u) << "no limb is so fast";
}

}  // namespace
}  // namespace boresight::tracking
