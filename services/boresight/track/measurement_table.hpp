// The measurements of a simulated scenario: a table with the columns step, x, y and, optionally, range_rate.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "services/common/estimation/unknown.hpp"

namespace boresight::track {

struct MeasuredPoint {
  Eigen::Vector2d position_m{Eigen::Vector2d::Zero()};
  double range_rate_mps = kNaN;  ///< over ground, seen from the origin; NaN if not measured
};

struct MeasurementTable {
  bool has_range_rates = false;
  std::vector<std::vector<MeasuredPoint>> scans;  ///< scan of step k at index k − 1; a scan may be empty
};

/// Rows in any order, other columns ignored. Throws score::InputError, which names file, line, column and the allowed
/// values, if a step is not in 1 … number_of_scans, a cell is no number, or a scan has more than kMaxDetections rows.
[[nodiscard]] MeasurementTable read_measurements(const std::filesystem::path& file, std::size_t number_of_scans);

}  // namespace boresight::track
