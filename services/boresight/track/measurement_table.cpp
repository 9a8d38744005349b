#include "services/boresight/track/measurement_table.hpp"

#include <fmt/format.h>

#include "interfaces/messages/header.hpp"
#include "services/boresight/score/table.hpp"

namespace boresight::track {

MeasurementTable read_measurements(const std::filesystem::path& file, std::size_t number_of_scans) {
  constexpr double kFarthest_m = 1e6, kFastest_mps = 1e3;
  score::Table table(file, {"step", "x", "y"});
  MeasurementTable measurements{table.has("range_rate"), {}};
  measurements.scans.resize(number_of_scans);
  while (table.next()) {
    const std::int64_t step = table.integer("step", 1, static_cast<std::int64_t>(number_of_scans));
    std::vector<MeasuredPoint>& scan = measurements.scans[static_cast<std::size_t>(step - 1)];
    if (scan.size() == kMaxDetections) {
      table.refuse("step", fmt::format("at most {} measurements for each step", kMaxDetections));
    }
    MeasuredPoint& point = scan.emplace_back();
    point.position_m = {table.number("x", -kFarthest_m, kFarthest_m), table.number("y", -kFarthest_m, kFarthest_m)};
    if (measurements.has_range_rates) point.range_rate_mps = table.number("range_rate", -kFastest_mps, kFastest_mps);
  }
  return measurements;
}

}  // namespace boresight::track
