#include "services/common/extended_object/range_rate_model.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight::extended_object {
namespace {

using Eigen::Vector2d;

const ObjectClassTable kRangeRateTable = object_class_table_defaults();

Vector2d unit(double degrees) {
  return {std::cos(degrees * M_PI / 180.0), std::sin(degrees * M_PI / 180.0)};
}

TEST(RigidRangeRate, IsThatOfThePointOnTheTurningBodyAtAnyRange) {
  const Vector2d sensor(1.0, 2.0), centre(20.0, 9.0), velocity(7.0, -3.0);
  const double turn = 0.35;
  for (const double degrees : {-30.0, 0.0, 20.0, 100.0}) {
    for (const double range : {0.5, 15.0, 60.0}) {
      const Vector2d point = sensor + range * unit(degrees), arm = point - centre;
      const Vector2d point_velocity = velocity + turn * Vector2d(-arm.y(), arm.x());
      const Vector2d sight = line_of_sight(sensor, point);
      EXPECT_NEAR(rigid_range_rate_mps(sight, sensor, centre, velocity, turn), sight.dot(point_velocity), 1e-12);
    }
  }
}

TEST(RigidRangeRate, IsZeroWhereSensorAndPointCoincide) {
  const Vector2d at(3.0, 4.0);
  EXPECT_DOUBLE_EQ(rigid_range_rate_mps(line_of_sight(at, at), at, {0.0, 0.0}, {5.0, 5.0}, 1.0), 0.0);
}

TEST(RangeRateDensity, IntegratesToOneAndHasTheStatedMoments) {
  for (const ObjectClassModel& m : kRangeRateTable) {
    for (const double degrees : {0.0, 30.0, 90.0, 150.0, 180.0}) {
      for (const double body : {-15.0, -1.0, 0.0, 4.0}) {
        const RangeRateMixture mixture = range_rate_mixture(m.micro_doppler, unit(degrees), body, 15.0);
        const double noise = 0.02, step = 0.01;
        double mass = 0.0, mean = 0.0, square = 0.0;
        for (double rate = -80.0; rate < 80.0; rate += step) {
          const double w = step * range_rate_density(mixture, rate, noise);
          mass += w;
          mean += w * rate;
          square += w * rate * rate;
        }
        const RangeRateMoments moments = range_rate_moments(mixture);
        EXPECT_NEAR(mass, 1.0, 1e-6);
        EXPECT_NEAR(mean, moments.mean_mps, 1e-5);
        EXPECT_NEAR(square - mean * mean, moments.variance_m2ps2 + noise, 1e-4);
      }
    }
  }
}

TEST(RangeRateDensity, VehiclesDeviateAbeamAndHardlyElsewhere) {
  const MicroDoppler& car = model_of(kRangeRateTable, RoadUserClass::kCar).micro_doppler;
  const auto body_share = [&](double degrees) { return range_rate_mixture(car, unit(degrees), 5.0, 15.0)[0].weight; };
  EXPECT_NEAR(body_share(0.0), 1.0 - car.rear_share, 1e-12);  // line of sight along the heading: from behind
  EXPECT_NEAR(body_share(180.0), 1.0 - car.front_share, 1e-12);
  EXPECT_NEAR(body_share(90.0), 1.0 - car.side_share, 1e-12);
  EXPECT_DOUBLE_EQ(body_share(70.0), body_share(-70.0));
  EXPECT_GT(body_share(30.0), 0.9);
}

TEST(RangeRateDensity, ObjectsAtRestHaveNoMicroDoppler) {
  for (const ObjectClassModel& m : kRangeRateTable) {
    const RangeRateMixture mixture = range_rate_mixture(m.micro_doppler, unit(90.0), 0.0, 0.0);
    const double body = m.micro_doppler.body_std_mps;
    EXPECT_NEAR(range_rate_moments(mixture).variance_m2ps2, body * body, 1e-6);
  }
}

TEST(RangeRateDensity, VarianceIsContinuousInAspectAndSpeed) {
  const MicroDoppler& car = model_of(kRangeRateTable, RoadUserClass::kCar).micro_doppler;
  const auto variance = [&](double degrees, double speed) {
    const Vector2d sight = unit(degrees);
    return range_rate_moments(range_rate_mixture(car, sight, speed * sight.x(), speed)).variance_m2ps2;
  };
  for (double degrees = -180.0; degrees < 180.0; degrees += 0.5) {
    EXPECT_NEAR(variance(degrees, 12.0), variance(degrees + 0.01, 12.0), 2e-2);
  }
  for (double speed = 0.0; speed < 5.0; speed += 0.05) {
    EXPECT_NEAR(variance(80.0, speed), variance(80.0, speed + 1e-3), 1e-2);
  }
}

TEST(BodyProbability, IsHighAtTheBodysRateAndVanishesFarFromIt) {
  const MicroDoppler& car = model_of(kRangeRateTable, RoadUserClass::kCar).micro_doppler;
  const RangeRateMixture abeam = range_rate_mixture(car, unit(80.0), 2.0, 12.0);
  EXPECT_GT(body_probability(abeam, 2.0, 0.003), 0.9);
  EXPECT_LT(body_probability(abeam, 3.0, 0.003), 1e-6);
  EXPECT_DOUBLE_EQ(body_probability(abeam, 1e6, 0.003), 0.0);
}

}  // namespace
}  // namespace boresight::extended_object
