// The result of a calibration with reflectors as table and JSON.
#pragma once

#include <string>

#include "services/alignment_estimator/core/reflectors/reflectors.hpp"
#include "services/boresight/calibrate/reflectors_csv.hpp"

namespace boresight::calibrate {

struct ReflectorRun {
  std::string tool_version;
  std::string source;
  RadarConfig radar;
  ReflectorTable table;
  alignment::reflectors::Config config;
  alignment::reflectors::Result result;
  alignment::reflectors::LineResult line;
};

/// The problem with its place in the file and the allowed values; "" if there is none.
[[nodiscard]] std::string problem_of(const ReflectorRun& run, alignment::reflectors::Problem problem,
                                     std::size_t position);

[[nodiscard]] std::string to_table(const ReflectorRun& run);
/// Angles in degrees; null for unknown values.
[[nodiscard]] std::string to_json(const ReflectorRun& run);

}  // namespace boresight::calibrate
