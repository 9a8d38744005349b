#include "services/boresight/track/filter_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/boresight/run/csv_row.hpp"
#include "services/tracker/core/filters/polar_measurement.hpp"

namespace boresight::track {

namespace {

using tracking::filters::MotionFilter;
using tracking::filters::MotionState;

/// The estimates of one pass; the first row that the filter refused ends it.
FilterRun one_pass(tracking::filters::FilterKind kind, const RadarMeasurements& measurements, const FilterSetup& setup,
                   std::int64_t (*cpu_time_ns)()) {
  constexpr double kNanosecondsPerMicrosecond = 1e3;
  tracking::filters::ProcessNoise noise;
  noise.jerk_density_m2ps5 = setup.jerk_density_m2ps5;
  FilterRun run;
  run.estimates.reserve(measurements.rows.size());
  const std::int64_t begin_ns = cpu_time_ns();
  MotionFilter filter(kind, start_of(measurements.rows.front(), setup), setup.sigma_points);
  for (std::size_t i = 1; i < measurements.rows.size(); ++i) {
    const RadarMeasurement& row = measurements.rows[i];
    const auto steps = static_cast<double>(row.step - measurements.rows[i - 1].step);
    const CartesianMeasurement measured = cartesian(row, setup);
    if (!filter.predict(steps * setup.step_s, noise) ||
        !filter.update(measured.position_m, measured.covariance_m2, measured.range_rate, Eigen::Vector2d::Zero())) {
      run.refused_row = i;
      break;
    }
    run.estimates.push_back(filter.state());
  }
  const auto spent_ns = static_cast<double>(cpu_time_ns() - begin_ns);
  const auto steps = static_cast<double>(std::max<std::size_t>(run.estimates.size(), 1));
  run.mean_cpu_us = spent_ns / kNanosecondsPerMicrosecond / steps;
  return run;
}

bool is_same(const std::vector<MotionState>& a, const std::vector<MotionState>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const MotionState& p, const MotionState& q) {
    return p.mean == q.mean && p.covariance == q.covariance;
  });
}

}  // namespace

CartesianMeasurement cartesian(const RadarMeasurement& measurement, const FilterSetup& setup) {
  const Eigen::Vector2d along(std::cos(measurement.azimuth_rad), std::sin(measurement.azimuth_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  const double across_std_m = measurement.range_m * setup.azimuth_std_rad;
  return {measurement.range_m * along,
          setup.range_std_m * setup.range_std_m * along * along.transpose() +
              across_std_m * across_std_m * across * across.transpose(),
          {along, measurement.range_rate_mps, setup.range_rate_std_mps * setup.range_rate_std_mps}};
}

MotionState start_of(const RadarMeasurement& first, const FilterSetup& setup) {
  const CartesianMeasurement measured = cartesian(first, setup);
  const Eigen::Vector2d velocity_mps = measured.range_rate.mean_mps * measured.range_rate.line_of_sight;
  MotionState start;
  start.mean << measured.position_m.x(), velocity_mps.x(), 0.0, measured.position_m.y(), velocity_mps.y(), 0.0;
  start.covariance.setZero();
  const double speed_variance = setup.start_speed_std_mps * setup.start_speed_std_mps;
  const double acceleration_variance = setup.start_acceleration_std_mps2 * setup.start_acceleration_std_mps2;
  start.covariance.diagonal() << measured.covariance_m2(0, 0), speed_variance, acceleration_variance,
      measured.covariance_m2(1, 1), speed_variance, acceleration_variance;
  start.covariance(0, 3) = start.covariance(3, 0) = measured.covariance_m2(0, 1);
  return start;
}

FilterRun run_filter(tracking::filters::FilterKind kind, const RadarMeasurements& measurements,
                     const FilterSetup& setup, std::size_t passes, std::int64_t (*cpu_time_ns)(),
                     const std::function<void()>& between_passes) {
  FilterRun first;
  for (std::size_t pass = 0; pass < passes; ++pass) {
    if (between_passes) between_passes();
    FilterRun run = one_pass(kind, measurements, setup, cpu_time_ns);
    if (pass == 0) {
      first = std::move(run);
      continue;
    }
    first.mean_cpu_us = std::min(first.mean_cpu_us, run.mean_cpu_us);
    first.is_repeatable = first.is_repeatable && is_same(first.estimates, run.estimates);
  }
  return first;
}

Eigen::Vector3d seen_from_origin(const ObjectState& state) {
  return tracking::filters::PolarMeasurement<double>{}.expected(state);
}

Eigen::Vector3d std_seen_from_origin(const MotionState& state) {
  const Eigen::Matrix<double, 3, 6> jacobian = tracking::filters::PolarMeasurement<double>{}.jacobian(state.mean);
  return (jacobian * state.covariance * jacobian.transpose()).diagonal().cwiseSqrt();
}

std::string filter_csv(const RadarMeasurements& measurements, const FilterRun& run) {
  std::string text = "k,x,vx,ax,y,vy,ay,range,azimuth_rad,radial_speed\n";
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const ObjectState& mean = run.estimates[i].mean;
    const Eigen::Vector3d seen = seen_from_origin(mean);
    run::CsvRow row(text);
    row.number(measurements.rows[i + 1].step);
    for (const double value : mean) row.number(value);
    for (const double value : seen) row.number(value);
    row.end();
  }
  return text;
}

}  // namespace boresight::track
