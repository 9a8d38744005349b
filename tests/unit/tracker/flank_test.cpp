// The line along the flank of a long vehicle, among what else is seen of it.
#include "services/tracker/core/flank.hpp"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace boresight::tracking {
namespace {

const Eigen::Vector2d kSensor_m(3.6, 0.0);

Cluster line_of(int number, double length_m, double angle_rad) {
  Cluster cluster{};
  const Eigen::Vector2d along(std::cos(angle_rad), std::sin(angle_rad));
  for (int i = 0; i < number; ++i) {
    cluster.outline[cluster.number_on_outline++] = Eigen::Vector2d(20.0, -5.0) + length_m * i / (number - 1) * along;
  }
  cluster.position_m = Eigen::Vector2d(20.0, -5.0) + 0.5 * length_m * along;
  return cluster;
}

TEST(Flank, TellsTheHeadingOfALongVehicle) {
  const auto truck = turn_of_flank(line_of(5, 12.0, 0.0), 0.3, kSensor_m, true);
  ASSERT_TRUE(truck);
  EXPECT_NEAR(truck->difference_rad, -0.3, 1e-9);
  EXPECT_LT(truck->variance, 0.01);
  EXPECT_FALSE(turn_of_flank(line_of(5, 3.0, 0.0), 0.3, kSensor_m, true)) << "too short";
  EXPECT_FALSE(turn_of_flank(line_of(2, 12.0, 0.0), 0.3, kSensor_m, true)) << "two points make no line";
  EXPECT_FALSE(turn_of_flank(line_of(5, 12.0, 0.0), 1.0, kSensor_m, true)) << "rather its end";
  Cluster bent = line_of(5, 8.0, 0.0);
  bent.outline[4] += Eigen::Vector2d(0.0, -2.5);
  bent.outline[3] += Eigen::Vector2d(0.0, -2.5);
  bent.outline[2] += Eigen::Vector2d(0.0, -1.5);
  EXPECT_FALSE(turn_of_flank(bent, 0.3, kSensor_m, true)) << "no line";
}

TEST(Flank, IsNoDiagonalThroughACar) {
  // A far rear corner, a wheel and the near front corner, all within 4.5 m: as spread as if they were 5 m long.
  Cluster car{};
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(52.8, 4.4), {55.0, 3.5}, {57.2, 2.65}}) {
    car.outline[car.number_on_outline++] = at;
  }
  EXPECT_FALSE(turn_of_flank(car, 0.0, kSensor_m, true));
}

TEST(Flank, DoesNotReachOverToTheNextVehicle) {
  // A wheel and a corner of a car in the next lane, and the rear of the one ahead.
  Cluster two{};
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(14.3, -2.7), {16.6, -1.7}, {18.8, -0.9}, {18.7, 0.7}}) {
    two.outline[two.number_on_outline++] = at;
  }
  EXPECT_FALSE(turn_of_flank(two, 0.1, kSensor_m, true));
  two.number_on_outline = 3;
  EXPECT_FALSE(turn_of_flank(two, 0.1, kSensor_m, true)) << "too short";
}

TEST(Flank, IsAsUnsureAsAzimuthsMakeIt) {
  Cluster truck = line_of(5, 12.0, 0.0);
  truck.weight = 5.0;
  const auto sure = turn_of_flank(truck, 0.0, kSensor_m, true);
  constexpr double kNoise_m = 0.7;
  truck.covariance_m2 = kNoise_m * kNoise_m / truck.weight * Eigen::Matrix2d::Identity();
  const auto unsure = turn_of_flank(truck, 0.0, kSensor_m, true);
  ASSERT_TRUE(sure && unsure);
  // Least squares: the noise's variance beside the sum of the squared distances from the middle, 5 x 18 m².
  EXPECT_NEAR(unsure->variance - sure->variance, kNoise_m * kNoise_m / 90.0, 1e-9);
}

/// A truck 16.5 m long and 2.5 m wide whose rear is 20 m ahead and whose left side is seen, heading for `heading_rad`:
/// its rear, axles on both sides, as radars see below it, and its far corner.
Cluster truck(double heading_rad, double noise_m, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, noise_m);
  const Eigen::Vector2d rear(20.0, -2.35), along(std::cos(heading_rad), std::sin(heading_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  Cluster cluster{};
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(0.0, 0.0),
                                    {0.0, -1.25},
                                    {0.0, -2.5},
                                    {2.1, 0.0},
                                    {3.7, 0.0},
                                    {5.6, 0.0},
                                    {5.6, -1.3},
                                    {5.6, -2.5},
                                    {14.4, 0.0}}) {
    cluster.outline[cluster.number_on_outline++] =
        rear + at.x() * along + at.y() * across + Eigen::Vector2d(noise(random), noise(random));
  }
  return cluster;
}

TEST(Flank, IsNotTurnedByTheEndThatIsSeenAsWell) {
  std::mt19937 random(1);
  for (const double heading_rad : {0.0, 0.3, -2.0}) {
    for (const double off_rad : {-0.15, 0.0, 0.15}) {
      const Cluster seen = truck(heading_rad, 0.0, random);
      const Eigen::Vector2d sensor_m = seen.outline[0] + Eigen::Rotation2Dd(heading_rad) * Eigen::Vector2d(-16.0, 3.0);
      const auto turn = turn_of_flank(seen, heading_rad + off_rad, sensor_m, true);
      ASSERT_TRUE(turn) << heading_rad;
      EXPECT_NEAR(turn->difference_rad, -off_rad, 1e-9) << heading_rad;
      EXPECT_FALSE(turn_of_flank(seen, heading_rad + off_rad, sensor_m, false)) << "may be a car and another";
    }
  }
}

TEST(Flank, ErrsByNoMoreThanItSays) {
  std::mt19937 random(2);
  constexpr double kNoise_m = 0.15;
  double squares = 0.0, variances = 0.0;
  constexpr int kDraws = 400;
  for (int i = 0; i < kDraws; ++i) {
    Cluster seen = truck(0.0, kNoise_m, random);
    seen.weight = 9.0;
    seen.covariance_m2 = kNoise_m * kNoise_m / seen.weight * Eigen::Matrix2d::Identity();
    const auto turn = turn_of_flank(seen, 0.1, kSensor_m, true);
    ASSERT_TRUE(turn);
    squares += std::pow(turn->difference_rad + 0.1, 2) / kDraws;
    variances += turn->variance / kDraws;
  }
  EXPECT_LT(squares, variances);
  EXPECT_LT(std::sqrt(squares), 0.02);
}

}  // namespace
}  // namespace boresight::tracking
