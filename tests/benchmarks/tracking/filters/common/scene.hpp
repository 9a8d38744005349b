// The published test of square-root filters (Liang and Guo 2016): one object of constant acceleration, seen by one
// radar.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/boresight/track/filter_run.hpp"
#include "tests/benchmarks/tracking/filters/common/forms.hpp"

namespace boresight::bench::filters {

/// RMS errors in range (m), azimuth (°) and range rate (m/s), and the normalised squared error of the state per
/// component.
struct Accuracy {
  Eigen::Vector3d rms = Eigen::Vector3d::Zero();
  double nees = 0.0;
};

struct Scene {
  const char* name;
  track::ObjectState start;
  Accuracy extended, unscented;  ///< of 10,000 runs by another implementation, as published: origin of the bars
};
/// Approach and crossing.
[[nodiscard]] const std::array<Scene, 2>& scenes();

/// Steps of a run, and the first ones that the errors do not count.
inline constexpr std::size_t kSteps = 200, kSkipped = 20;

struct Run {
  std::vector<Eigen::Vector3d> measured;
  std::vector<track::ObjectState> truth;
};
/// The same seed gives the same run.
[[nodiscard]] Run draw_run(const Scene& scene, std::uint64_t seed);

/// Range, azimuth in radians and range rate from the origin.
[[nodiscard]] Eigen::Vector3d seen(const track::ObjectState& state);

template <typename Real>
struct Model {
  ConstantAcceleration<Real, 2> motion;
  Noise<Real, 3> noise;
  PolarMeasurement<Real> sensor;
};
/// With the settings of the published test.
template <typename Real>
[[nodiscard]] Model<Real> model() {
  const track::FilterSetup setup;
  ProcessNoise jerk;
  jerk.jerk_density_m2ps5 = setup.jerk_density_m2ps5;
  return {ConstantAcceleration<Real, 2>(setup.step_s, jerk),
          independent_noise<Real, 3>({setup.range_std_m, setup.azimuth_std_rad, setup.range_rate_std_mps}),
          {}};
}

template <typename Real>
[[nodiscard]] Gaussian<Real, 6> start_of(const Run& run) {
  const Eigen::Vector3d& first = run.measured.front();
  const MotionState state = track::start_of({0, first(0), first(1), first(2)}, {});
  return {state.mean.cast<Real>(), state.covariance.cast<Real>()};
}

}  // namespace boresight::bench::filters
