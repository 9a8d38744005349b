#include "services/tracker/core/classes/object_forest.hpp"

namespace boresight::tracking {

std::span<const ForestNumber> forest_numbers() {
  static const std::array<ForestNumber, 16> kNumbers = {{
      {"exponent", 0.01, 100.0, [](ObjectForest& f) -> double& { return f.table.exponent; }},
      {"memory_s", 0.1, 100.0, [](ObjectForest& f) -> double& { return f.evidence.memory_s; }},
      {"count_range_m", 1.0, 300.0, [](ObjectForest& f) -> double& { return f.evidence.count_range_m; }},
      {"count_power", 0.0, 4.0, [](ObjectForest& f) -> double& { return f.evidence.count_power; }},
      {"near_range_m", 0.1, 100.0, [](ObjectForest& f) -> double& { return f.evidence.near_range_m; }},
      {"wide_range_rate_mps", 0.01, 10.0, [](ObjectForest& f) -> double& { return f.evidence.wide_range_rate_mps; }},
      {"least_in_view", 0.0, 1.0, [](ObjectForest& f) -> double& { return f.evidence.least_in_view; }},
      {"course_s", 0.01, 10.0, [](ObjectForest& f) -> double& { return f.evidence.course_s; }},
      {"gate_m", 0.0, 100.0, [](ObjectForest& f) -> double& { return f.evidence.gate_m; }},
      {"gate_rad", 0.0, 1.0, [](ObjectForest& f) -> double& { return f.evidence.gate_rad; }},
      {"gate_most_std_m", 0.0, 100.0, [](ObjectForest& f) -> double& { return f.evidence.gate_most_std_m; }},
      {"gate_mps", 0.01, 100.0, [](ObjectForest& f) -> double& { return f.evidence.gate_mps; }},
      {"gate_by_speed", 0.0, 10.0, [](ObjectForest& f) -> double& { return f.evidence.gate_by_speed; }},
      {"level_memory_s", 0.1, 1000.0, [](ObjectForest& f) -> double& { return f.levels.memory_s; }},
      {"level_prior_number", 0.001, 1e6, [](ObjectForest& f) -> double& { return f.levels.prior_number; }},
      {"level_first_band_m", 1.0, 100.0, [](ObjectForest& f) -> double& { return f.levels.first_band_m; }},
  }};
  return kNumbers;
}

}  // namespace boresight::tracking
