#include "services/common/geometry/frames.hpp"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/ego_step.hpp"

namespace boresight::geometry {
namespace {

TEST(Frames, RotationIsTheProductOfItsThreeAxes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  for (int i = 0; i < 1000; ++i) {
    const double yaw = angle(random), pitch = angle(random), roll = angle(random);
    const Eigen::Matrix3d expected =
        (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    EXPECT_LT((sensor_to_vehicle(yaw, pitch, roll) - expected).norm(), 1e-12);
  }
}

TEST(Frames, SignsAreThoseOfTheConventions) {
  const Eigen::Vector3d boresight(1.0, 0.0, 0.0);
  EXPECT_GT((sensor_to_vehicle(0.1, 0.0, 0.0) * boresight).y(), 0.0) << "yaw turns left";
  EXPECT_GT((sensor_to_vehicle(0.0, 0.1, 0.0) * boresight).z(), 0.0) << "pitch looks up";
  EXPECT_GT((sensor_to_vehicle(0.0, 0.0, 0.1) * Eigen::Vector3d(0.0, 1.0, 0.0)).z(), 0.0) << "roll lifts the left side";
  EXPECT_GT(direction(0.1, 0.0).y(), 0.0) << "azimuth to the left";
  EXPECT_GT(direction(0.0, 0.1).z(), 0.0) << "elevation up";
}

TEST(Frames, ReflectorsAheadApproachAndReflectorsBehindRecede) {
  const Eigen::Vector3d velocity = sensor_velocity(1.0, 10.0, 0.0, {3.6, 0.0, 0.5});
  EXPECT_DOUBLE_EQ(stationary_range_rate({1.0, 0.0, 0.0}, velocity), -10.0);
  EXPECT_DOUBLE_EQ(stationary_range_rate({-1.0, 0.0, 0.0}, velocity), 10.0);
  EXPECT_DOUBLE_EQ(stationary_range_rate({0.0, 1.0, 0.0}, velocity), 0.0);
}

TEST(Frames, SensorVelocityIsTheDerivativeOfItsPlace) {
  // The sensor's world position after a short circular drive, differentiated numerically.
  const double speed = 12.0, yaw_rate = 0.35, scale = 1.02;
  const std::array<double, 3> place{3.4, -0.8, 0.6};
  const auto position = [&](double t) {
    const EgoStep step = ego_step(scale * speed, yaw_rate, t);
    return Eigen::Vector2d(step.translation_m + step.to_new.transpose() * Eigen::Vector2d(place[0], place[1]));
  };
  constexpr double h = 1e-5;
  const Eigen::Vector2d numeric = (position(h) - position(-h)) / (2.0 * h);
  const Eigen::Vector3d velocity = sensor_velocity(scale, speed, yaw_rate, place);
  EXPECT_NEAR(velocity.x(), numeric.x(), 1e-6);
  EXPECT_NEAR(velocity.y(), numeric.y(), 1e-6);
  EXPECT_EQ(velocity.z(), 0.0);
}

TEST(Frames, AnglesWrap) {
  EXPECT_NEAR(wrap_angle(3.5 * M_PI), -0.5 * M_PI, 1e-12);
  EXPECT_NEAR(wrap_angle(-181.0 * kRadiansPerDegree), 179.0 * kRadiansPerDegree, 1e-12);
  EXPECT_NEAR(wrap_angle(0.3), 0.3, 1e-15);
  EXPECT_EQ(wrap_angle(-M_PI), M_PI) << "the interval is open at −π";
  EXPECT_EQ(wrap_angle(M_PI), M_PI);
}

TEST(EgoStep, IsTheIntegralOfTheMotion) {
  for (const double yaw_rate : {0.0, 1e-7, 0.02, -0.5, 2.0}) {
    for (const double duration : {0.05, 1.0, -0.7}) {
      constexpr int kSteps = 200'000;
      Eigen::Vector2d place(0.0, 0.0);
      double heading = 0.0;
      const double dt = duration / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        const double middle = heading + 0.5 * yaw_rate * dt;
        place += 15.0 * dt * Eigen::Vector2d(std::cos(middle), std::sin(middle));
        heading += yaw_rate * dt;
      }
      const EgoStep step = ego_step(15.0, yaw_rate, duration);
      EXPECT_LT((step.translation_m - place).norm(), 1e-8) << yaw_rate << ", " << duration;
      const Eigen::Vector2d ahead(std::cos(heading), std::sin(heading));
      EXPECT_LT((step.rotate(ahead) - Eigen::Vector2d(1.0, 0.0)).norm(), 1e-9);
    }
  }
}

TEST(EgoStep, ThereAndBackIsWhereItWas) {
  const EgoStep there = ego_step(20.0, 0.3, 0.8), back = ego_step(20.0, 0.3, -0.8);
  const Eigen::Vector2d point(12.0, -7.0);
  EXPECT_LT((back.move_point(there.move_point(point)) - point).norm(), 1e-12);
}

}  // namespace
}  // namespace boresight::geometry
