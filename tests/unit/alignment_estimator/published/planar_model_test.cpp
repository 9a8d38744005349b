// (10)–(21) against differences, against the exact rotation where the two must agree, and against the printed
// equations of the straight road.
#include "services/alignment_estimator/core/published/planar_model.hpp"

#include <random>

#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"

namespace boresight::alignment::published {
namespace {

struct Case {
  MountingPose nominal;
  Eigen::Vector4d b;
  double speed_mps, yaw_rate_radps, azimuth_rad, elevation_rad;
};

std::vector<Case> cases(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Case> all;
  for (int i = 0; i < count; ++i) {
    Case c;
    c.nominal = {{4.0 * unit(random), unit(random), 0.5}, 3.1 * unit(random), 0.1 * unit(random), 0.1 * unit(random)};
    c.b = {1.0 + 0.05 * unit(random), 0.09 * unit(random), 0.09 * unit(random), 0.09 * unit(random)};
    c.speed_mps = 20.0 + 15.0 * unit(random);
    c.yaw_rate_radps = 0.6 * unit(random);
    c.azimuth_rad = 1.3 * unit(random);
    c.elevation_rad = 0.26 * unit(random);
    all.push_back(c);
  }
  return all;
}

double exact(const Case& c) {
  const Eigen::Vector3d u = geometry::sensor_to_vehicle(c.nominal, c.b(1), c.b(2), c.b(3)) *
                            geometry::direction(c.azimuth_rad, c.elevation_rad);
  return geometry::stationary_range_rate(
      u, geometry::sensor_velocity(c.b(0), c.speed_mps, c.yaw_rate_radps, c.nominal.position_m));
}

TEST(PlanarModel, GradientAgreesWithDifferences) {
  for (Case c : cases(500)) {
    for (const bool straight : {false, true}) {
      if (straight) c.yaw_rate_radps = 0.0;
      const RangeRate r = PlanarModel(c.nominal, c.b, c.speed_mps, c.yaw_rate_radps)(c.azimuth_rad, c.elevation_rad);
      for (int p = 0; p < 4; ++p) {
        constexpr double kStep = 1e-6;
        Eigen::Vector4d above = c.b, below = c.b;
        above(p) += kStep;
        below(p) -= kStep;
        const double difference =
            PlanarModel(c.nominal, above, c.speed_mps, c.yaw_rate_radps).value(c.azimuth_rad, c.elevation_rad) -
            PlanarModel(c.nominal, below, c.speed_mps, c.yaw_rate_radps).value(c.azimuth_rad, c.elevation_rad);
        EXPECT_NEAR(r.gradient(p), difference / (2.0 * kStep), 1e-7) << "parameter " << p;
      }
      EXPECT_EQ(r.value_mps,
                PlanarModel(c.nominal, c.b, c.speed_mps, c.yaw_rate_radps).value(c.azimuth_rad, c.elevation_rad));
    }
  }
}

TEST(PlanarModel, IsTheRotationWhereThereIsNeitherPitchNorRoll) {
  for (Case c : cases(200)) {
    c.nominal.pitch_rad = c.nominal.roll_rad = c.b(2) = c.b(3) = 0.0;
    EXPECT_NEAR(PlanarModel(c.nominal, c.b, c.speed_mps, c.yaw_rate_radps).value(c.azimuth_rad, c.elevation_rad),
                exact(c), 1e-12);
    c.nominal.roll_rad = M_PI;  // upside down
    EXPECT_NEAR(PlanarModel(c.nominal, c.b, c.speed_mps, c.yaw_rate_radps).value(c.azimuth_rad, c.elevation_rad),
                exact(c), 1e-12);
  }
}

TEST(PlanarModel, GradientsOfSpeedYawAndPitchAheadAreThoseOfTheRotation) {
  for (Case c : cases(200)) {
    c.nominal.pitch_rad = c.nominal.roll_rad = c.b(2) = c.b(3) = 0.0;
    c.azimuth_rad = 0.0;  // off the boresight the planar pitch differs from that of the rotation
    const RangeRate r = PlanarModel(c.nominal, c.b, c.speed_mps, c.yaw_rate_radps)(c.azimuth_rad, c.elevation_rad);
    for (int p = 0; p < 3; ++p) {
      Case above = c, below = c;
      above.b(p) += 1e-6;
      below.b(p) -= 1e-6;
      EXPECT_NEAR(r.gradient(p), (exact(above) - exact(below)) / 2e-6, 1e-7) << "parameter " << p;
    }
  }
}

TEST(PlanarModel, IsNotARotationElsewhere) {
  // docs/algorithms/published-alignment.md: 2° of each error, 60° to the side: off by more than a degree, which is 0.1
  // m/s and more.
  constexpr double kTwoDegrees = 2.0 * M_PI / 180.0;
  const Case c{{{3.6, 0.7, 0.5}, 0.785, 0.0, 0.0}, {1.0, 0.0, kTwoDegrees, kTwoDegrees}, 20.0, 0.0, 1.047, 0.15};
  EXPECT_GT(std::abs(PlanarModel(c.nominal, c.b, c.speed_mps, 0.0).value(c.azimuth_rad, c.elevation_rad) - exact(c)),
            0.1);
}

TEST(PlanarModel, OnlyTheSumOfMountingAndAzimuthCounts) {
  for (Case c : cases(100)) {
    c.nominal.roll_rad = c.b(3) = 0.0;
    Case turned = c;
    turned.nominal.yaw_rad += 2.0;
    turned.azimuth_rad -= 2.0;
    EXPECT_NEAR(
        PlanarModel(c.nominal, c.b, c.speed_mps, c.yaw_rate_radps).value(c.azimuth_rad, c.elevation_rad),
        PlanarModel(turned.nominal, turned.b, c.speed_mps, c.yaw_rate_radps).value(turned.azimuth_rad, c.elevation_rad),
        1e-12);
  }
}

TEST(PlanarModel, WithoutYawRateIsTheStraightRoad) {
  for (const Case& c : cases(200)) {
    const double roll = c.nominal.roll_rad + c.b(3);
    const double a = c.nominal.yaw_rad + c.b(1) + c.azimuth_rad * std::cos(roll) - c.elevation_rad * std::sin(roll);
    const double e = c.nominal.pitch_rad + c.b(2) + c.elevation_rad * std::cos(roll) + c.azimuth_rad * std::sin(roll);
    const double v = c.speed_mps, k = c.b(0);
    const RangeRate r = PlanarModel(c.nominal, c.b, v, 0.0)(c.azimuth_rad, c.elevation_rad);
    EXPECT_NEAR(r.value_mps, -k * v * std::cos(a) * std::cos(e), 1e-12);   // (17)
    EXPECT_NEAR(r.gradient(0), -v * std::cos(a) * std::cos(e), 1e-12);     // (18)
    EXPECT_NEAR(r.gradient(1), k * v * std::sin(a) * std::cos(e), 1e-12);  // (19)
    EXPECT_NEAR(r.gradient(2), k * v * std::cos(a) * std::sin(e), 1e-12);  // (20)
    const double by_a = -c.azimuth_rad * std::sin(roll) - c.elevation_rad * std::cos(roll);
    const double by_e = c.azimuth_rad * std::cos(roll) - c.elevation_rad * std::sin(roll);
    EXPECT_NEAR(r.gradient(3), k * v * (std::sin(a) * std::cos(e) * by_a + std::cos(a) * std::sin(e) * by_e), 1e-12);
  }
}

}  // namespace
}  // namespace boresight::alignment::published
