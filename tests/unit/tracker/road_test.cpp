// Headings along the road, and how many vehicles drive along it.
#include "services/tracker/core/model/road.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

constexpr double kPi = std::numbers::pi;
const RoadParameters kParameters;

/// Moments of heading × likelihood of the course, about `middle_rad`, by summing over the circle.
Course summed(const Road& road, const Course& course, double vehicle_probability, double middle_rad) {
  const auto density = [](double e, double variance) {
    double sum = 0.0;
    for (int k = -6; k <= 6; ++k) sum += std::exp(-0.5 * std::pow(e + 2.0 * kPi * k, 2) / variance);
    return sum / std::sqrt(2.0 * kPi * variance);
  };
  constexpr int kSteps = 20000;
  const double std2 = std::pow(kParameters.parallel_std_rad, 2);
  double weights = 0.0, mean = 0.0, squares = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double off = -kPi + 2.0 * kPi * (i + 0.5) / kSteps, heading = middle_rad + off;
    const double prior = vehicle_probability * (road.along_share * density(heading - road.heading_rad, std2) +
                                                road.against_share * density(heading - road.heading_rad - kPi, std2)) +
                         (1.0 - vehicle_probability * (road.along_share + road.against_share)) / (2.0 * kPi);
    const double w = prior * density(heading - course.rad, course.variance_rad2);
    weights += w;
    mean += w * off;
    squares += w * off * off;
  }
  mean /= weights;
  return {std::remainder(middle_rad + mean, 2.0 * kPi), squares / weights - mean * mean};
}

TEST(OnRoad, IsThePosteriorOfTheCourse) {
  const Road road{0.3, 0.5, 0.2};
  for (const double off : {0.0, 0.2, -0.4, 0.8}) {
    for (const double std_rad : {0.02, 0.1, 0.3}) {
      const Course course{road.heading_rad + off, std_rad * std_rad};
      const Course got = on_road(kParameters, road, course, 0.9);
      const Course expected = summed(road, course, 0.9, course.rad);
      EXPECT_NEAR(std::remainder(got.rad - expected.rad, 2.0 * kPi), 0.0, 0.01) << off << " " << std_rad;
      EXPECT_NEAR(std::sqrt(got.variance_rad2), std::sqrt(expected.variance_rad2), 0.02) << off << " " << std_rad;
    }
  }
}

TEST(OnRoad, IsInvariantToRotation) {
  const Course course{0.25, 0.04};
  const Course a = on_road(kParameters, {0.0, 0.4, 0.3}, course, 1.0);
  const Course b = on_road(kParameters, {2.9, 0.4, 0.3}, {course.rad + 2.9, course.variance_rad2}, 1.0);
  EXPECT_NEAR(std::remainder(b.rad - a.rad - 2.9, 2.0 * kPi), 0.0, 1e-12);
  EXPECT_NEAR(b.variance_rad2, a.variance_rad2, 1e-12);
}

TEST(OnRoad, UnknownCourseIsTheMoreUsualWay) {
  const Course got = on_road(kParameters, {1.0, 0.9, 0.02}, {-1.5, 1e3}, 1.0);
  EXPECT_NEAR(got.rad, 1.0, 0.3);
  EXPECT_GT(got.variance_rad2, 0.02);
}

TEST(OnRoad, PedestriansDoNotCare) {
  const Course course{0.7, 0.09};
  const Course got = on_road(kParameters, {0.0, 0.5, 0.4}, course, 0.0);
  EXPECT_NEAR(got.rad, course.rad, 1e-12);
  EXPECT_NEAR(got.variance_rad2, course.variance_rad2, 1e-12);
}

TEST(ParallelTraffic, StartsWithThePrior) {
  const Road road = ParallelTraffic(kParameters).road(0.4);
  EXPECT_DOUBLE_EQ(road.heading_rad, 0.4);
  EXPECT_DOUBLE_EQ(road.along_share, kParameters.parallel_share);
  EXPECT_DOUBLE_EQ(road.against_share, kParameters.parallel_share);
}

TEST(ParallelTraffic, LearnsTheShares) {
  support::Random random(5);
  ParallelTraffic traffic(kParameters);
  // Ten vehicles at a time: six along, one against, three anywhere, with courses known to 0.05 rad.
  constexpr double kStd_rad = 0.05, kStep_s = 0.05;
  double along = 0.0, against = 0.0;
  constexpr int kSteps = 8000, kSettled = 4000;
  for (int i = 0; i < kSteps; ++i) {
    traffic.forget(kStep_s);
    for (int v = 0; v < 10; ++v) {
      const double way = v < 7 ? kParameters.parallel_std_rad * support::normal(random) + (v == 6 ? kPi : 0.0)
                               : support::uniform(random, -kPi, kPi);
      traffic.add({0.8 + way + kStd_rad * support::normal(random), kStd_rad * kStd_rad}, 0.8, kStep_s);
    }
    const Road road = traffic.road(0.8);
    if (i < kSettled) continue;
    along += road.along_share / (kSteps - kSettled);
    against += road.against_share / (kSteps - kSettled);
  }
  // The start counts for ten of 210 seconds.
  EXPECT_NEAR(along, (200.0 * 0.6 + 10.0 * 0.35) / 210.0, 0.03);
  EXPECT_NEAR(against, (200.0 * 0.1 + 10.0 * 0.35) / 210.0, 0.03);
}

TEST(ParallelTraffic, ForgetsWithoutVehicles) {
  ParallelTraffic traffic(kParameters);
  traffic.add({0.0, 1e-4}, 0.0, 100.0);
  EXPECT_GT(traffic.road(0.0).along_share, 0.8);
  traffic.forget(20.0 * kParameters.memory_s);
  EXPECT_NEAR(traffic.road(0.0).along_share, kParameters.parallel_share, 1e-6);
}

TEST(ParallelTraffic, CoursesThatAreHardlyKnownDoNotCount) {
  ParallelTraffic traffic(kParameters);
  traffic.add({0.0, 1.0}, 0.0, 100.0);
  EXPECT_DOUBLE_EQ(traffic.road(0.0).along_share, kParameters.parallel_share);
}

}  // namespace
}  // namespace boresight::tracking
