#include "services/common/extended_object/reflection_model.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/extended_object/range_rate_model.hpp"

namespace boresight::extended_object {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const ObjectClassTable kReflectionTable = object_class_table_defaults();

Vector2d polar(double range, double angle) {
  return {range * std::cos(angle), range * std::sin(angle)};
}

/// Sensors all around a box of this class, near and far.
std::vector<Vector2d> sensors_around(const SizePrior& size) {
  std::vector<Vector2d> sensors;
  for (const double beyond : {0.5, 3.0, 40.0}) {
    for (const double degrees : {0.0, 7.0, 45.0, 90.0, 120.0, 180.0, -60.0}) {
      const double at = degrees * M_PI / 180.0;
      sensors.push_back(polar(beyond, at) + Vector2d(std::copysign(0.5 * size.length_mean_m, std::cos(at)),
                                                     std::copysign(0.5 * size.width_mean_m, std::sin(at))));
    }
  }
  return sensors;
}

struct Integral {
  double mass = 0.0;
  Vector2d mean{0.0, 0.0};
  Matrix2d covariance = Matrix2d::Zero();
};

/// Mass, mean and covariance of a density over a rectangle, by the midpoint rule.
Integral integrate(const std::function<double(const Vector2d&)>& density, const Vector2d& half, double step) {
  Integral sum;
  for (double x = -half.x() + 0.5 * step; x < half.x(); x += step) {
    for (double y = -half.y() + 0.5 * step; y < half.y(); y += step) {
      const Vector2d at(x, y);
      const double mass = density(at) * step * step;
      sum.mass += mass;
      sum.mean += mass * at;
      sum.covariance += mass * at * at.transpose();
    }
  }
  sum.mean /= sum.mass;
  sum.covariance = sum.covariance / sum.mass - sum.mean * sum.mean.transpose();
  return sum;
}

TEST(ReflectionDensity, IntegratesToOneAndHasTheStatedMoments) {
  Matrix2d noise;
  noise << 0.06, 0.02, 0.02, 0.04;
  for (const ObjectClassModel& m : kReflectionTable) {
    const double length = m.size.length_mean_m, width = m.size.width_mean_m;
    for (const Vector2d& sensor : sensors_around(m.size)) {
      const ReflectionMixture mixture = reflection_mixture(m.places, length, width, sensor);
      const ReflectionMoments moments = reflection_moments(m.places, length, width, sensor);
      const Integral numeric = integrate([&](const Vector2d& at) { return position_density(mixture, at, noise); },
                                         Vector2d(0.5 * length, 0.5 * width) + Vector2d(2.5, 2.5), 0.06);
      EXPECT_NEAR(numeric.mass, 1.0, 1e-3) << sensor.transpose();
      EXPECT_LT((numeric.mean - moments.mean_m).norm(), 5e-3) << sensor.transpose();
      EXPECT_LT((numeric.covariance - moments.scatter_m2 - noise).norm(), 2e-2) << sensor.transpose();
    }
  }
}

TEST(ReflectionDensity, MomentsAreThoseOfSamples) {
  const ObjectClassModel& truck = model_of(kReflectionTable, RoadUserClass::kTruck);
  const Vector2d sensor(-14.0, 4.0);
  const ReflectionMixture mixture = reflection_mixture(truck.places, 12.0, 2.5, sensor);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::array<double, kReflectionComponents> weights;
  for (std::size_t k = 0; k < weights.size(); ++k) weights[k] = mixture[k].weight;
  std::discrete_distribution<std::size_t> part(weights.begin(), weights.end());
  constexpr int kSamples = 400000;
  Vector2d mean(0.0, 0.0);
  Matrix2d square = Matrix2d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const ReflectionComponent& c = mixture[part(random)];
    const Vector2d at = c.mean_m + c.variance_m2.cwiseSqrt().cwiseProduct(Vector2d(normal(random), normal(random)));
    mean += at / kSamples;
    square += at * at.transpose() / kSamples;
  }
  const ReflectionMoments moments = reflection_moments(truck.places, 12.0, 2.5, sensor);
  EXPECT_LT((mean - moments.mean_m).norm(), 0.02);
  EXPECT_LT((square - mean * mean.transpose() - moments.scatter_m2).norm(), 0.05);
}

// Equations (2) and (3) without the closed forms: slope of the range by sampling, moments of the uncut exponentials by
// quadrature.
TEST(ReflectionDensity, CuttingIntoGaussiansKeepsTheMomentsOfTheContinuousModel) {
  ReflectionPlaces places = model_of(kReflectionTable, RoadUserClass::kTruck).places;
  places.interior_share = 1.0;
  const Vector2d half(6.0, 1.25);
  for (const Vector2d& sensor : {Vector2d(-30.0, 5.0), Vector2d(-7.0, 2.0), Vector2d(1.0, 4.0), Vector2d(9.0, -60.0)}) {
    const auto mean_slope = [&](const Vector2d& axis, double reach) {
      constexpr int kSteps = 20000;
      double slope = 0.0;
      for (int i = 0; i < kSteps; ++i) {
        const Vector2d way = sensor - axis * reach * ((2.0 * i + 1.0) / kSteps - 1.0);
        slope += axis.dot(way) / way.norm() / kSteps;
      }
      return slope;
    };
    const Vector2d rate = Vector2d(mean_slope({1.0, 0.0}, half.x()), mean_slope({0.0, 1.0}, half.y())) / places.decay_m;
    const Integral numeric = integrate([&](const Vector2d& at) { return std::exp(rate.dot(at)); }, half, 0.01);
    const ReflectionMoments moments = reflection_moments(places, 2.0 * half.x(), 2.0 * half.y(), sensor);
    EXPECT_LT((numeric.mean - moments.mean_m).norm(), 1e-3) << sensor.transpose();
    EXPECT_LT((numeric.covariance - moments.scatter_m2).norm(), 2e-3) << sensor.transpose();
  }
}

TEST(ReflectionDensity, FacesWeighTheirProjectedLengthsFromAfar) {
  ReflectionPlaces places = model_of(kReflectionTable, RoadUserClass::kCar).places;
  for (const double degrees : {20.0, 50.0, 70.0}) {
    const double at = degrees * M_PI / 180.0;
    const ReflectionMixture mixture = reflection_mixture(places, 4.6, 1.85, polar(5000.0, at));
    const double side = mixture[1].weight + mixture[2].weight + mixture[3].weight;
    EXPECT_NEAR(side / mixture[0].weight, 4.6 * std::sin(at) / (1.85 * std::cos(at)), 1e-2);
    EXPECT_NEAR(side + mixture[0].weight, 1.0 - places.interior_share, 1e-12);
    EXPECT_GT(mixture[3].weight, mixture[1].weight) << "the near part of the side reflects more";
    EXPECT_GT(mixture[6].weight, mixture[4].weight);
  }
}

TEST(ReflectionDensity, SeenFromWithinHasNoFaces) {
  const ReflectionMixture mixture =
      reflection_mixture(model_of(kReflectionTable, RoadUserClass::kCar).places, 4.6, 1.85, {0.5, 0.2});
  for (std::size_t k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(mixture[k].weight, 0.0);
}

/// Densities at four points of the box, and the mean of the reflections.
using Features = Eigen::Matrix<double, 6, 1>;
Features features(const ObjectClassModel& m, const Vector2d& sensor) {
  const Vector2d size(m.size.length_mean_m, m.size.width_mean_m);
  const ReflectionMixture mixture = reflection_mixture(m.places, size.x(), size.y(), sensor);
  Features f = Features::Zero();
  const std::array<Vector2d, 4> points = {Vector2d(0.45 * size), Vector2d(-0.45 * size),
                                          Vector2d(0.15 * size.x(), -0.5 * size.y()), Vector2d(0.0, 0.0)};
  for (int i = 0; i < 4; ++i) {
    f[i] = position_density(mixture, points[static_cast<std::size_t>(i)], 0.05 * Matrix2d::Identity());
  }
  for (const ReflectionComponent& c : mixture) f.tail<2>() += c.weight * c.mean_m;
  return f;
}

/// Largest second difference along a path, by the step: it falls with the step where the path has no kink.
double largest_kink(const ObjectClassModel& m, const std::function<Vector2d(double)>& path, double step) {
  double largest = 0.0;
  Features before = features(m, path(-step)), here = features(m, path(0.0));
  for (double at = step; at < 2.0 * M_PI; at += step) {
    const Features next = features(m, path(at));
    largest = std::max(largest, (next - 2.0 * here + before).cwiseAbs().maxCoeff() / step);
    before = here;
    here = next;
  }
  return largest;
}

TEST(ReflectionDensity, IsOnceDifferentiableInAspectAndRange) {
  constexpr double kCoarse = 2e-3, kFine = 5e-4, kFalls = 0.35;  // 0.25 expected
  for (const ObjectClassModel& m : kReflectionTable) {
    const Vector2d half(0.5 * m.size.length_mean_m, 0.5 * m.size.width_mean_m);
    for (const double beyond : {0.1, 1.0, 20.0}) {
      const auto around = [&](double at) { return polar(half.norm() + beyond, at + 1e-4); };
      EXPECT_LT(largest_kink(m, around, kFine), kFalls * largest_kink(m, around, kCoarse) + 1e-6)
          << half.transpose() << " " << beyond;
    }
    const auto through = [&](double at) { return Vector2d((at - M_PI) * half.x(), 0.5 * half.y()); };
    EXPECT_LT(largest_kink(m, through, kFine), kFalls * largest_kink(m, through, kCoarse) + 1e-6) << half.transpose();
  }
}

struct Scene {
  ObservedObject object;
  Vector2d sensor;
  ObservedDetection detection;
};

Scene example(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Scene s;
  s.object = {{{30.0 * unit(random), 20.0 * unit(random)}, 4.0 * unit(random), 4.6, 1.85},
              {10.0 * unit(random), 10.0 * unit(random)},
              0.4 * unit(random)};
  s.sensor = {3.6, 0.5};
  s.detection.position_m = s.object.box.from_box({2.0 * unit(random), unit(random)});
  s.detection.covariance_m2 << 0.09, 0.02, 0.02, 0.04;
  s.detection.range_rate_mps =
      rigid_range_rate_mps(line_of_sight(s.sensor, s.detection.position_m), s.sensor, s.object.box.centre_m,
                           s.object.velocity_mps, s.object.turn_rate_radps) +
      0.1 * unit(random);
  s.detection.range_rate_variance_m2ps2 = 0.01;
  return s;
}

TEST(DetectionDensity, IsInvariantToRotationAndShiftOfTheScene) {
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    const Scene s = example(random);
    const double turn = 0.3 + 0.7 * i;
    Matrix2d rotation;
    rotation << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
    const Vector2d shift(-17.0, 5.0);
    Scene t = s;
    t.object.box.centre_m = rotation * s.object.box.centre_m + shift;
    t.object.box.heading_rad += turn;
    t.object.velocity_mps = rotation * s.object.velocity_mps;
    t.sensor = rotation * s.sensor + shift;
    t.detection.position_m = rotation * s.detection.position_m + shift;
    t.detection.covariance_m2 = rotation * s.detection.covariance_m2 * rotation.transpose();
    for (const ObjectClassModel& m : kReflectionTable) {
      const double density = detection_density(m, s.object, s.sensor, s.detection);
      EXPECT_GT(density, 0.0);
      EXPECT_NEAR(detection_density(m, t.object, t.sensor, t.detection) / density, 1.0, 1e-9);
    }
  }
}

TEST(DetectionDensity, IsTheSameInAMirroredScene) {
  std::mt19937 random(12);
  for (int i = 0; i < 50; ++i) {
    const Scene s = example(random);
    const auto mirrored = [](const Vector2d& v) { return Vector2d(v.x(), -v.y()); };
    Scene t = s;
    t.object.box.centre_m = mirrored(s.object.box.centre_m);
    t.object.box.heading_rad *= -1.0;
    t.object.velocity_mps = mirrored(s.object.velocity_mps);
    t.object.turn_rate_radps *= -1.0;
    t.sensor = mirrored(s.sensor);
    t.detection.position_m = mirrored(s.detection.position_m);
    t.detection.covariance_m2(0, 1) *= -1.0;
    t.detection.covariance_m2(1, 0) *= -1.0;
    for (const ObjectClassModel& m : kReflectionTable) {
      EXPECT_NEAR(
          detection_density(m, t.object, t.sensor, t.detection) / detection_density(m, s.object, s.sensor, s.detection),
          1.0, 1e-9);
    }
  }
}

TEST(DetectionDensity, FavoursTheNearSideOverTheFarSide) {
  const ObjectClassModel& car = model_of(kReflectionTable, RoadUserClass::kCar);
  const ObservedObject object{{{20.0, 0.0}, 0.0, 4.6, 1.85}, {10.0, 0.0}, 0.0};
  ObservedDetection near, far;
  near.position_m = {18.0, 0.0};
  far.position_m = {22.0, 0.0};
  near.covariance_m2 = far.covariance_m2 = 0.04 * Matrix2d::Identity();
  near.range_rate_mps = far.range_rate_mps = 10.0;
  near.range_rate_variance_m2ps2 = far.range_rate_variance_m2ps2 = 0.01;
  EXPECT_GT(detection_density(car, object, {0.0, 0.0}, near), 4.0 * detection_density(car, object, {0.0, 0.0}, far));
  near.range_rate_mps = 6.0;
  EXPECT_LT(detection_density(car, object, {0.0, 0.0}, near), 0.1 * detection_density(car, object, {0.0, 0.0}, far));
}

// An object that crosses at 15 m/s: an azimuth error of 0.01 rad is 0.15 m/s of range rate.
TEST(DetectionDensity, WidensTheRangeRateByTheAzimuthErrorOfWhatCrosses) {
  ObjectClassModel model = model_of(kReflectionTable, RoadUserClass::kCar);
  model.micro_doppler = {.body_std_mps = 0.1};
  const ObservedObject object{{{40.0, 0.0}, 0.5 * M_PI, 4.6, 1.85}, {0.0, 15.0}, 0.0};
  ObservedDetection d;
  d.position_m = {39.5, 0.0};
  const double across_std = 0.01 * 39.5;
  d.covariance_m2 = Vector2d(0.01, across_std * across_std).asDiagonal();
  d.range_rate_variance_m2ps2 = 0.05 * 0.05;
  const double at_body = detection_density(model, object, {0.0, 0.0}, d);
  d.range_rate_mps = 0.2;
  const double variance = 0.1 * 0.1 + 0.05 * 0.05 + 0.15 * 0.15;
  EXPECT_NEAR(detection_density(model, object, {0.0, 0.0}, d) / at_body, std::exp(-0.5 * 0.2 * 0.2 / variance), 1e-4);
}

TEST(DetectionDensity, IsFiniteInDegenerateCases) {
  for (const ObjectClassModel& m : kReflectionTable) {
    for (const Vector2d& size : {Vector2d(4.6, 1.85), Vector2d(0.0, 0.0), Vector2d(4.0, 0.0), Vector2d(0.0, 2.0)}) {
      const ObservedObject object{{{0.0, 0.0}, 0.0, size.x(), size.y()}, {3.0, 1.0}, 0.1};
      for (const Vector2d& sensor :
           {Vector2d(0.0, 0.0), Vector2d(-0.0, -0.0), Vector2d(0.5 * size.x(), 0.0), Vector2d(0.0, 0.5 * size.y()),
            Vector2d(0.5 * size.x(), 0.5 * size.y()), Vector2d(0.5, 0.2), Vector2d(1e4, 0.0)}) {
        double weights = 0.0;
        for (const ReflectionComponent& c : reflection_mixture(m.places, size.x(), size.y(), sensor)) {
          EXPECT_GE(c.weight, 0.0);
          EXPECT_TRUE(c.mean_m.allFinite());
          EXPECT_GT(c.variance_m2.minCoeff(), 0.0);
          weights += c.weight;
        }
        EXPECT_NEAR(weights, 1.0, 1e-12);
        const ReflectionMoments moments = reflection_moments(m.places, size.x(), size.y(), sensor);
        EXPECT_TRUE(moments.mean_m.allFinite() && moments.mean_by_length.allFinite() && moments.scatter_m2.allFinite());
        for (const Vector2d& at : {sensor, Vector2d(0.0, 0.0), Vector2d(500.0, 1.0)}) {
          ObservedDetection detection;  // without noise
          detection.position_m = at;
          const double density = detection_density(m, object, sensor, detection);
          EXPECT_TRUE(std::isfinite(density)) << size.transpose() << " " << sensor.transpose();
          EXPECT_GE(density, 0.0);
        }
      }
    }
  }
}

// Places that are held from scan to scan with correlation ρ: the mean over many scans of n of them.
TEST(HeldNoiseFactor, IsThatOfTheMeanOverManyScans) {
  const ReflectionPlaces& places = model_of(kReflectionTable, RoadUserClass::kCar).places;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit;
  constexpr int kDetections = 3, kScans = 100, kRuns = 4000;
  double variance = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    double sum = 0.0;
    for (int spot = 0; spot < kDetections; ++spot) {
      double place = normal(random);
      for (int scan = 0; scan < kScans; ++scan) {
        if (unit(random) >= places.scan_correlation) place = normal(random);
        sum += place / (kDetections * kScans);
      }
    }
    variance += sum * sum / kRuns;
  }
  EXPECT_NEAR(held_noise_factor(places.scan_correlation) / (kDetections * kScans * variance), 1.0, 0.1);
}

TEST(ReflectionMoments, LengthMovesTheCentreByHalfBehindAnEnd) {
  ReflectionPlaces places = model_of(kReflectionTable, RoadUserClass::kCar).places;
  places.interior_share = 0.0;
  const ReflectionMoments m = reflection_moments(places, 4.6, 1.85, {-50.0, 0.0});
  EXPECT_NEAR(m.mean_m.x(), -2.3 + places.face_depth_m, 1e-9);
  EXPECT_NEAR(m.mean_by_length.x(), -0.5, 1e-6);
  EXPECT_NEAR(m.mean_by_length.y(), 0.0, 1e-6);
}

TEST(ReflectionMoments, MeanLiesTowardsTheSensorWithinTheBox) {
  for (const ObjectClassModel& m : kReflectionTable) {
    for (const Vector2d& sensor : sensors_around(m.size)) {
      const ReflectionMoments moments = reflection_moments(m.places, m.size.length_mean_m, m.size.width_mean_m, sensor);
      EXPECT_GT(moments.mean_m.dot(sensor), 0.0);
      EXPECT_LT(std::abs(moments.mean_m.x()), 0.5 * m.size.length_mean_m);
      EXPECT_LT(std::abs(moments.mean_m.y()), 0.5 * m.size.width_mean_m);
    }
  }
}

}  // namespace
}  // namespace boresight::extended_object
