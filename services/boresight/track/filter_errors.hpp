// How much a filter improves the measurements of one object: the table of Liang and Guo 2016.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "services/boresight/track/filter_run.hpp"

namespace boresight::track {

/// Range, azimuth or range rate, in the unit of tables and charts.
struct Quantity {
  const char* name;
  const char* unit;
  double factor;  ///< from m, rad and m/s
};
inline constexpr std::array<Quantity, 3> kQuantities = {
    {{"range", "m", 1.0}, {"azimuth", "°", kDegreesPerRadian}, {"radial speed", "m/s", 1.0}}};

[[nodiscard]] Eigen::Vector3d value_of(const RadarMeasurement& row);
/// With the azimuth in −π … π.
[[nodiscard]] Eigen::Vector3d difference_of_values(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// RMS errors in range (m), azimuth (rad) and range rate (m/s) beside the true state.
struct FilterErrors {
  std::size_t steps = 0;  ///< number of steps that count; without one the errors are zero
  Eigen::Vector3d measured = Eigen::Vector3d::Zero(), filtered = Eigen::Vector3d::Zero();
};

/// The first steps, while the filter settles, do not count: those less than `skipped_steps` after the first row. The
/// truth is known.
[[nodiscard]] FilterErrors filter_errors(const RadarMeasurements& measurements, const FilterRun& run,
                                         std::size_t skipped_steps);

/// Rows for range, azimuth (in degrees) and range rate.
[[nodiscard]] std::string filter_errors_text(const FilterErrors& errors, std::size_t skipped_steps);

}  // namespace boresight::track
