// What the tests of the motion filters share: the scene of Liang and Guo 2016, its noise, and a start from one
// measurement.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "services/common/geometry/angles.hpp"
#include "services/tracker/core/filters/constant_acceleration.hpp"
#include "services/tracker/core/filters/fast_srukf.hpp"
#include "services/tracker/core/filters/kalman.hpp"
#include "services/tracker/core/filters/ukf.hpp"

namespace boresight::tracking::filters::testing {

using Vector6 = Vector<double, 6>;
using Matrix6 = Matrix<double, 6, 6>;

constexpr double kStep_s = 0.05;
inline const Vector<double, 3> kNoiseStd(1.0, kRadiansPerDegree, 0.05);  // m, rad, m/s

template <typename Real>
using Published = FastSquareRootUnscented<Real, FastForm::kPublished>;
template <typename Real>
using CovarianceForm = FastSquareRootUnscented<Real, FastForm::kCovariance>;
template <typename Real>
using PureRoot = FastSquareRootUnscented<Real, FastForm::kPureRoot>;

[[nodiscard]] inline ProcessNoise lasting_acceleration(double jerk_density_m2ps5) {
  ProcessNoise noise;
  noise.jerk_density_m2ps5 = jerk_density_m2ps5;
  return noise;
}

template <typename Real>
[[nodiscard]] ConstantAcceleration<Real, 2> scene_motion() {
  return {kStep_s, lasting_acceleration(0.1)};
}
template <typename Real>
[[nodiscard]] Noise<Real, 3> scene_noise() {
  return independent_noise<Real, 3>(kNoiseStd);
}

/// The place is that of the measurement, the velocity its radial part; accelerations are unknown within 3 m/s².
template <typename Real>
[[nodiscard]] Gaussian<Real, 6> start_of(const Vector<double, 3>& measured) {
  const double range_m = measured(0), c = std::cos(measured(1)), s = std::sin(measured(1));
  const double across_m2 = std::pow(range_m * kNoiseStd(1), 2), along_m2 = kNoiseStd(0) * kNoiseStd(0);
  Vector6 mean;
  mean << range_m * c, measured(2) * c, 0.0, range_m * s, measured(2) * s, 0.0;
  Vector6 variances;
  variances << c * c * along_m2 + s * s * across_m2, 100.0, 9.0, s * s * along_m2 + c * c * across_m2, 100.0, 9.0;
  Matrix6 covariance = variances.asDiagonal();
  covariance(0, 3) = covariance(3, 0) = c * s * (along_m2 - across_m2);
  return {mean.cast<Real>(), covariance.cast<Real>()};
}

struct Truth {
  const char* name;
  Vector6 start;
};
[[nodiscard]] inline std::array<Truth, 2> scenes() {
  std::array<Truth, 2> scenes;
  scenes[0].name = "approach";
  scenes[0].start << 80.0, -12.0, 0.8, -3.0, 0.3, 0.0;
  scenes[1].name = "crossing";
  scenes[1].start << 25.0, -1.0, 0.1, -20.0, 4.0, 0.0;
  return scenes;
}

struct Run {
  std::vector<Vector6> truth;
  std::vector<Vector<double, 3>> measured;
};
/// 200 steps of constant acceleration with noisy measurements.
[[nodiscard]] inline Run draw_run(const Vector6& start, std::uint64_t seed, int steps = 200) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const ConstantAcceleration<double, 2> motion(kStep_s, lasting_acceleration(0.0));
  const PolarMeasurement<double> sensor;
  Run run;
  Vector6 state = start;
  for (int k = 0; k < steps; ++k) {
    Vector<double, 3> measured = sensor.expected(state);
    for (int i = 0; i < 3; ++i) measured(i) += kNoiseStd(i) * normal(random);
    run.truth.push_back(state);
    run.measured.push_back(measured);
    motion.move(state);
  }
  return run;
}

/// A filter over a run from its first measurement on; `look` gets the step and the filter after each update.
template <typename Filter, typename Real, typename Look>
[[nodiscard]] bool follow(const Run& run, Look&& look) {
  const ConstantAcceleration<Real, 2> motion = scene_motion<Real>();
  const Noise<Real, 3> noise = scene_noise<Real>();
  const PolarMeasurement<Real> sensor;
  Filter filter(start_of<Real>(run.measured.front()));
  for (std::size_t k = 1; k < run.measured.size(); ++k) {
    const Vector<Real, 3> measured = run.measured[k].cast<Real>();
    if (!filter.predict(motion) || !filter.update(sensor, measured, noise)) return false;
    look(k, filter);
  }
  return true;
}

}  // namespace boresight::tracking::filters::testing
