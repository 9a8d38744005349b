#include "services/boresight/align/table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "services/boresight/align/json.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::align {

namespace {

using text::padded;

/// Of the first column; longer names widen it.
constexpr std::size_t kLeastNameColumns = 20;

std::string name_of(const RadarResult& radar) {
  return fmt::format("{} {}", radar.id, radar.name);
}

std::size_t name_columns(const std::vector<RadarResult>& radars) {
  std::size_t width = kLeastNameColumns;
  for (const RadarResult& radar : radars) width = std::max(width, text::columns(name_of(radar)) + 1);
  return width;
}

std::string angle(double value_rad, double std_rad, bool observable) {
  if (!observable) return "not observable";
  return text::with_std(value_rad * kDegreesPerRadian, std_rad * kDegreesPerRadian, "°", text::Sign::kAlways);
}

std::string seconds(double value) {
  return std::isfinite(value) ? fmt::format("{:.1f}", value) : "–";
}

std::string mps(double value) {
  return std::isfinite(value) ? fmt::format("{:.4f}", value) : "–";
}

}  // namespace

std::string to_table(const Result& result) {
  std::string table = fmt::format("{}: {} scans, {} detections, {} ego motions", result.method, result.scans,
                                  result.detections, result.ego_motions);
  if (result.scans > 0) table += fmt::format(", {:.1f} s", result.end_s - result.start_s);
  table += "\nmounting error about the vehicle's axes, ± one standard deviation:\n";
  const std::size_t name_width = name_columns(result.radars);
  constexpr std::size_t kAngle = 21;
  table += padded("radar", name_width) + padded("yaw", kAngle) + padded("pitch", kAngle) + padded("roll", kAngle) +
           padded("RMSE m/s", 18) + padded("95 % after s", 17) + padded("µs/scan", 9) + "state\n";
  for (const RadarResult& r : result.radars) {
    const AlignmentEstimate& m = r.message;
    table += padded(name_of(r), name_width);
    table += padded(angle(m.vehicle_yaw_rad, r.stds[1], m.is_observable(alignment_axis::kVehicleYaw)), kAngle);
    table += padded(angle(m.vehicle_pitch_rad, r.stds[2], m.is_observable(alignment_axis::kVehiclePitch)), kAngle);
    table += padded(angle(m.vehicle_roll_rad, r.stds[3], m.is_observable(alignment_axis::kVehicleRoll)), kAngle);
    table += padded(mps(r.residuals.before.rmse_mps) + " → " + mps(r.residuals.after.rmse_mps), 18);
    const auto& t95 = m.kpis.seconds_to_95_percent;
    table += padded(seconds(t95[1]) + " / " + seconds(t95[2]) + " / " + seconds(t95[3]), 17);
    table += padded(std::isfinite(r.cpu_us_per_scan) ? fmt::format("{:.1f}", r.cpu_us_per_scan) : "–", 9);
    table += name_of(m.state);
    if (!r.step_changes.empty())
      table += fmt::format(", {} step change{}", r.step_changes.size(), r.step_changes.size() == 1 ? "" : "s");
    table += '\n';
    constexpr std::array<const char*, 3> kSensorAxes = {"alpha", "beta", "gamma"};
    for (std::size_t i = 0; i < r.support.size(); ++i) {
      table += padded("", name_width) + kSensorAxes.at(i) + " " + r.support[i] + '\n';
    }
    if (r.truth) {
      const auto error = [&](std::size_t i) {
        return text::error_in_stds(r.truth->errors.at(i) * kDegreesPerRadian, r.stds.at(i) * kDegreesPerRadian, "°");
      };
      table += padded("  error", name_width) + padded(error(1), kAngle) + padded(error(2), kAngle) + error(3) + '\n';
    }
  }
  table += result.speed_scale_observable ? "k_v " + text::with_std(result.speed_scale, result.speed_scale_std)
                                         : "k_v not observable";
  if (result.true_speed_scale) {
    table += ", error " + text::error_in_stds(result.speed_scale - *result.true_speed_scale, result.speed_scale_std);
  }
  if (!result.series.empty()) {
    const Sample& last = result.series.back();
    if (last.yaw_rate_bias_std_radps > 0.0) {
      table += ", yaw-rate bias " + text::with_std(last.yaw_rate_bias_radps * kDegreesPerRadian,
                                                   last.yaw_rate_bias_std_radps * kDegreesPerRadian, "°/s",
                                                   text::Sign::kAlways);
    }
    if (last.slip_coefficient_std_radps2pm > 0.0) {
      table += ", slip " + text::with_std(last.slip_coefficient_radps2pm, last.slip_coefficient_std_radps2pm,
                                          " rad/(m/s²)", text::Sign::kAlways);
    }
  }
  return table + '\n';
}

}  // namespace boresight::align
