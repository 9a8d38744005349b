// A motion filter over the measurements of one object, as in the published test of square-root filters (Liang and Guo
// 2016).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "services/boresight/track/radar_measurements.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/tracker/core/filters/motion_filter.hpp"

namespace boresight::track {

/// The defaults are those of the published test.
struct FilterSetup {
  double step_s = 0.05;
  double range_std_m = 1.0;
  double azimuth_std_rad = kRadiansPerDegree;
  double range_rate_std_mps = 0.05;
  double jerk_density_m2ps5 = 0.1;
  tracking::filters::SigmaPointParameters sigma_points;
  double start_speed_std_mps = 10.0;  ///< of each axis, about the measured range rate
  double start_acceleration_std_mps2 = 3.0;
};

/// Place and covariance of a measurement, Cartesian: what MotionFilter takes.
struct CartesianMeasurement {
  Eigen::Vector2d position_m;
  Eigen::Matrix2d covariance_m2;
  tracking::filters::RangeRate range_rate;
};
[[nodiscard]] CartesianMeasurement cartesian(const RadarMeasurement& measurement, const FilterSetup& setup);

/// The state after one measurement: its place, the radial part of the velocity, no acceleration.
[[nodiscard]] tracking::filters::MotionState start_of(const RadarMeasurement& first, const FilterSetup& setup);

struct FilterRun {
  std::vector<tracking::filters::MotionState> estimates;  ///< of each row after the first, up to a refused one
  std::optional<std::size_t> refused_row;                 ///< the filter could not use it: its covariance was lost
  double mean_cpu_us = 0.0;                               ///< a step, of the quickest pass
  bool is_repeatable = true;                              ///< all passes had the same estimates
};

/// Runs a new filter in each of `passes` passes. `cpu_time_ns` reads the CPU time of the thread. `between_passes` may
/// throw to end the work.
[[nodiscard]] FilterRun run_filter(tracking::filters::FilterKind kind, const RadarMeasurements& measurements,
                                   const FilterSetup& setup, std::size_t passes, std::int64_t (*cpu_time_ns)(),
                                   const std::function<void()>& between_passes = {});

/// Range, azimuth and range rate of a state, seen from the origin.
[[nodiscard]] Eigen::Vector3d seen_from_origin(const ObjectState& state);
/// Their standard deviations.
[[nodiscard]] Eigen::Vector3d std_seen_from_origin(const tracking::filters::MotionState& state);

/// Columns k, x, vx, ax, y, vy, ay, range, azimuth_rad, radial_speed.
[[nodiscard]] std::string filter_csv(const RadarMeasurements& measurements, const FilterRun& run);

}  // namespace boresight::track
