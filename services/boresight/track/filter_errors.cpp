#include "services/boresight/track/filter_errors.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "services/common/text/columns.hpp"

namespace boresight::track {

Eigen::Vector3d value_of(const RadarMeasurement& row) {
  return {row.range_m, row.azimuth_rad, row.range_rate_mps};
}

Eigen::Vector3d difference_of_values(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Vector3d d = a - b;
  d(1) = std::remainder(d(1), 2.0 * std::numbers::pi);
  return d;
}

FilterErrors filter_errors(const RadarMeasurements& measurements, const FilterRun& run, std::size_t skipped_steps) {
  FilterErrors errors;
  const auto first_step = measurements.rows.front().step + static_cast<std::int64_t>(skipped_steps);
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const RadarMeasurement& row = measurements.rows[i + 1];
    if (row.step < first_step) continue;
    const Eigen::Vector3d truth = seen_from_origin(measurements.truth[i + 1]);
    errors.measured += difference_of_values(value_of(row), truth).cwiseAbs2();
    errors.filtered += difference_of_values(seen_from_origin(run.estimates[i].mean), truth).cwiseAbs2();
    ++errors.steps;
  }
  if (errors.steps > 0) {
    errors.measured = (errors.measured / static_cast<double>(errors.steps)).cwiseSqrt();
    errors.filtered = (errors.filtered / static_cast<double>(errors.steps)).cwiseSqrt();
  }
  return errors;
}

std::string filter_errors_text(const FilterErrors& errors, std::size_t skipped_steps) {
  if (errors.steps == 0) return fmt::format("no step after the first {}: no errors are stated\n", skipped_steps);
  constexpr std::size_t kNameWidth = 20;
  std::string text = fmt::format("RMS errors in {} steps, without the first {}\n{}{:>10}{:>10}{:>10}\n", errors.steps,
                                 skipped_steps, text::padded("", kNameWidth), "measured", "filtered", "ratio");
  for (std::size_t i = 0; i < kQuantities.size(); ++i) {
    const Quantity& quantity = kQuantities[i];
    const auto index = static_cast<Eigen::Index>(i);
    const double measured = errors.measured(index), filtered = errors.filtered(index);
    text += fmt::format("{}{:>10.4f}{:>10.4f}{:>10.3f}\n",
                        text::padded(fmt::format("{}, {}", quantity.name, quantity.unit), kNameWidth),
                        quantity.factor * measured, quantity.factor * filtered, filtered / measured);
  }
  return text;
}

}  // namespace boresight::track
