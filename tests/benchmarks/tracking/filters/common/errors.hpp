// Errors of a filter over runs.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Cholesky>

#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/tracking/filters/common/scene.hpp"

namespace boresight::bench::filters {

/// Mean squares over the steps of one run.
struct RunErrors {
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();  ///< m², °², (m/s)²
  double nees = 0.0;
  bool has_failed = false;                                    ///< the filter lost its covariance
  track::ObjectState last_mean = track::ObjectState::Zero();  ///< of the last step
};

[[nodiscard]] inline Eigen::Vector3d squared_difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double azimuth_rad = std::remainder(a(1) - b(1), 2.0 * std::numbers::pi);
  return Eigen::Vector3d(a(0) - b(0), azimuth_rad * kDegreesPerRadian, a(2) - b(2)).cwiseAbs2();
}

/// A filter of the given type over a run.
template <typename Real, typename Filter>
[[nodiscard]] RunErrors errors_of(const Run& run, const Model<Real>& model) {
  RunErrors errors;
  Filter filter(start_of<Real>(run));
  for (std::size_t k = 1; k < run.measured.size(); ++k) {
    const Vector<Real, 3> measured = run.measured[k].cast<Real>();
    if (!filter.predict(model.motion) || !filter.update(model.sensor, measured, model.noise)) {
      errors.has_failed = true;
      return errors;
    }
    if (k < kSkipped) continue;
    const Gaussian<Real, 6> state = filter.gaussian();
    const track::ObjectState mean = state.mean.template cast<double>();
    const Matrix<double, 6, 6> covariance = state.covariance.template cast<double>();
    const track::ObjectState error = mean - run.truth[k];
    errors.squares += squared_difference(seen(mean), seen(run.truth[k]));
    errors.nees += error.dot(covariance.ldlt().solve(error)) / static_cast<double>(error.size());
    errors.last_mean = mean;
  }
  const auto steps = static_cast<double>(run.measured.size() - kSkipped);
  errors.squares /= steps;
  errors.nees /= steps;
  return errors;
}

/// Of the measurements themselves.
[[nodiscard]] inline RunErrors errors_of_measurements(const Run& run) {
  RunErrors errors;
  for (std::size_t k = kSkipped; k < run.measured.size(); ++k) {
    errors.squares += squared_difference(run.measured[k], seen(run.truth[k]));
  }
  errors.squares /= static_cast<double>(run.measured.size() - kSkipped);
  return errors;
}

[[nodiscard]] inline Accuracy accuracy_of(std::span<const RunErrors> runs) {
  Accuracy accuracy;
  for (const RunErrors& run : runs) {
    accuracy.rms += run.squares;
    accuracy.nees += run.nees;
  }
  const auto count = static_cast<double>(runs.size());
  accuracy.rms = (accuracy.rms / count).cwiseSqrt();
  accuracy.nees /= count;
  return accuracy;
}

/// 95 % interval of one RMS error, by a bootstrap over the runs.
[[nodiscard]] inline Interval rms_interval(std::span<const RunErrors> runs, Eigen::Index quantity) {
  return bootstrap(runs.size(), [&](const std::vector<std::size_t>& picks) {
    double sum = 0.0;
    for (const std::size_t pick : picks) sum += runs[pick].squares(quantity);
    return std::sqrt(sum / static_cast<double>(picks.size()));
  });
}

}  // namespace boresight::bench::filters
