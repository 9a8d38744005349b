// Accuracy over many seeds: a small part of the published test, single precision, and consistency of the covariance.
#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "services/tracker/core/filters/motion_filter.hpp"
#include "tests/unit/tracker/filters_support.hpp"

namespace boresight::tracking::filters {
namespace {

using testing::Matrix6;
using testing::Vector6;

struct Errors {
  Vector<double, 3> squares = Vector<double, 3>::Zero();
  long count = 0;
  [[nodiscard]] Vector<double, 3> rms() const { return (squares / static_cast<double>(count)).cwiseSqrt(); }
};

/// Errors in range, azimuth and range rate after the first 20 steps.
template <typename Filter, typename Real>
Vector<double, 3> rms_errors(const Vector6& start, int runs) {
  const PolarMeasurement<double> sensor;
  Errors errors;
  for (int seed = 1; seed <= runs; ++seed) {
    const testing::Run run = testing::draw_run(start, static_cast<std::uint64_t>(seed));
    const bool succeeds = testing::follow<Filter, Real>(run, [&](std::size_t k, const Filter& filter) {
      if (k < 20) return;
      const Vector6 mean = filter.gaussian().mean.template cast<double>();
      errors.squares +=
          PolarMeasurement<double>::difference(sensor.expected(mean), sensor.expected(run.truth[k])).cwiseAbs2();
      ++errors.count;
    });
    EXPECT_TRUE(succeeds) << seed;
  }
  return errors.rms();
}

TEST(MonteCarlo, HasThePublishedErrors) {
  // Of 10,000 runs (Liang and Guo 2016, checked by another implementation): m, rad, m/s. 300 runs differ by some
  // percent.
  const std::array<Vector<double, 3>, 2> published = {Vector<double, 3>(0.1138, 0.4425 * kRadiansPerDegree, 0.0252),
                                                      Vector<double, 3>(0.1135, 0.3554 * kRadiansPerDegree, 0.0257)};
  for (std::size_t i = 0; i < published.size(); ++i) {
    const Vector<double, 3> rms = rms_errors<testing::CovarianceForm<double>, double>(testing::scenes()[i].start, 300);
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(rms(j) / published[i](j), 1.0, 0.06) << testing::scenes()[i].name << j;
  }
}

TEST(MonteCarlo, SinglePrecisionIsAsAccurate) {
  const auto compare = [](auto precise, auto single, const char* name) {
    for (const testing::Truth& scene : testing::scenes()) {
      const Vector<double, 3> in_double = rms_errors<decltype(precise), double>(scene.start, 40);
      const Vector<double, 3> in_float = rms_errors<decltype(single), float>(scene.start, 40);
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(in_float(j) / in_double(j), 1.0, 0.01) << name << scene.name << j;
    }
  };
  const Gaussian<double, 6> d;
  const Gaussian<float, 6> f;
  compare(ExtendedKalman<double, 6>(d), ExtendedKalman<float, 6>(f), "ekf ");
  compare(Unscented<double, 6>(d), Unscented<float, 6>(f), "ukf ");
  compare(SquareRootUnscented<double, 6>(d), SquareRootUnscented<float, 6>(f), "srukf ");
  compare(testing::Published<double>(d), testing::Published<float>(f), "published ");
  compare(testing::CovarianceForm<double>(d), testing::CovarianceForm<float>(f), "covariance ");
  compare(testing::PureRoot<double>(d), testing::PureRoot<float>(f), "pure root ");
}

/// Normalised squared error of the state over a whole track, per component: 1 if the covariance states the errors. The
/// truth moves by the model's own random jerk.
double mean_nees(FilterKind kind, int runs) {
  ProcessNoise noise;
  noise.jerk_density_m2ps5 = 2.0;
  noise.acceleration_decay_s = 1.5;
  const ConstantAcceleration<double, 2> motion(0.06, noise);
  const Eigen::Vector2d sensor(3.6, 0.7);
  MotionState prior;
  prior.mean << 35.0, -6.0, 0.0, 9.0, 2.0, 0.0;
  Vector6 std;
  std << 0.5, 1.0, 1.0, 0.5, 1.0, 1.0;
  prior.covariance = std.cwiseAbs2().asDiagonal();
  double sum = 0.0;
  int count = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed) + 1000);
    std::normal_distribution<double> normal;
    const auto draw6 = [&] { return Vector6(Vector6::NullaryExpr([&](Eigen::Index) { return normal(random); })); };
    Vector6 truth = prior.mean + std.cwiseProduct(draw6());
    MotionFilter filter(kind, prior);
    for (int k = 0; k < 60; ++k) {
      motion.move(truth);
      truth += motion.noise().root * draw6();
      EXPECT_TRUE(filter.predict(0.06, noise));
      // Noise of range and azimuth, as a radar has, but so small that the Kalman filter is nearly right, too.
      const Eigen::Vector2d line = Eigen::Vector2d(truth(0), truth(3)) - sensor;
      const double range_m = line.norm() + 0.15 * normal(random);
      const double azimuth_rad = std::atan2(line.y(), line.x()) + 0.01 * normal(random);
      const Eigen::Vector2d along(std::cos(azimuth_rad), std::sin(azimuth_rad)), across(-along.y(), along.x());
      const Eigen::Matrix2d covariance =
          0.0225 * along * along.transpose() + 1e-4 * range_m * range_m * across * across.transpose();
      const double range_rate = line.normalized().dot(Eigen::Vector2d(truth(1), truth(4))) + 0.1 * normal(random);
      EXPECT_TRUE(filter.update(sensor + range_m * along, covariance, RangeRate{along, range_rate, 0.01}, sensor));
      const MotionState state = filter.state();
      const Vector6 error = state.mean - truth;
      sum += error.dot(state.covariance.ldlt().solve(error)) / 6.0;
      ++count;
    }
  }
  return sum / count;
}

TEST(MonteCarlo, CovarianceStatesTheErrorsOverAWholeTrack) {
  for (const std::string_view name : filter_kind_names()) {
    EXPECT_NEAR(mean_nees(*filter_kind(name), 150), 1.0, 0.07) << name;
  }
}

}  // namespace
}  // namespace boresight::tracking::filters
