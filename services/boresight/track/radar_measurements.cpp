#include "services/boresight/track/radar_measurements.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "services/boresight/score/table.hpp"

namespace boresight::track {

namespace {

constexpr std::array<std::string_view, 6> kTruthColumns = {"tx", "tvx", "tax", "ty", "tvy", "tay"};
constexpr std::int64_t kMaxStep = 1'000'000'000;
constexpr double kMaxDistance_m = 1e6, kMaxSpeed_mps = 1e4, kMaxAcceleration_mps2 = 1e4;

bool has_truth(const score::Table& table) {
  const auto is_there = [&](std::string_view column) { return table.has(column); };
  if (std::none_of(kTruthColumns.begin(), kTruthColumns.end(), is_there)) return false;
  const auto missing = std::find_if_not(kTruthColumns.begin(), kTruthColumns.end(), is_there);
  if (missing == kTruthColumns.end()) return true;
  throw score::InputError(fmt::format("{}: the header lacks the column {}; a true state has the columns {}",
                                      table.name(), *missing, fmt::join(kTruthColumns, ",")));
}

ObjectState truth_of(const score::Table& table) {
  constexpr std::array kLimits = {kMaxDistance_m, kMaxSpeed_mps, kMaxAcceleration_mps2};
  ObjectState state;
  for (std::size_t i = 0; i < kTruthColumns.size(); ++i) {
    const double limit = kLimits[i % kLimits.size()];
    state(static_cast<Eigen::Index>(i)) = table.number(kTruthColumns[i], -limit, limit);
  }
  return state;
}

}  // namespace

RadarMeasurements read_radar_measurements(const std::filesystem::path& file) {
  score::Table table(file, {"k", "range", "azimuth_rad", "radial_speed"});
  const bool is_truth_known = has_truth(table);
  RadarMeasurements measurements;
  while (table.next()) {
    RadarMeasurement row;
    row.step = table.integer("k", 0, kMaxStep);
    if (!measurements.rows.empty() && row.step <= measurements.rows.back().step) {
      table.refuse("k", fmt::format("more than {}, the step of the row before", measurements.rows.back().step));
    }
    row.range_m = table.number("range", std::numeric_limits<double>::min(), kMaxDistance_m);
    row.azimuth_rad = table.number("azimuth_rad", -std::numbers::pi, std::numbers::pi);
    row.range_rate_mps = table.number("radial_speed", -kMaxSpeed_mps, kMaxSpeed_mps);
    measurements.rows.push_back(row);
    if (is_truth_known) measurements.truth.push_back(truth_of(table));
  }
  if (measurements.rows.size() < 2) {
    throw score::InputError(
        fmt::format("{}: has {} rows of measurements; a filter starts from the first and needs more", table.name(),
                    measurements.rows.size()));
  }
  return measurements;
}

}  // namespace boresight::track
