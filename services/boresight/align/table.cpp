#include "services/boresight/align/table.hpp"

#include <cmath>

#include <fmt/format.h>

#include "services/boresight/align/json.hpp"

namespace boresight::align {

namespace {

constexpr double kDegrees = 180.0 / M_PI;

/// `text` in `width` columns; ± and ° are two bytes but one column.
std::string padded(const std::string& text, std::size_t width) {
  std::size_t columns = 0;
  for (const char c : text) columns += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
  return text + std::string(columns < width ? width - columns : 1, ' ');
}

std::string angle(double value_rad, double std_rad, bool observable) {
  if (!observable) return "not observable";
  return fmt::format("{:+.3f} ± {:.3f}°", value_rad * kDegrees, std_rad * kDegrees);
}

std::string seconds(double value) {
  return std::isfinite(value) ? fmt::format("{:.1f}", value) : "–";
}

std::string mps(double value) {
  return std::isfinite(value) ? fmt::format("{:.4f}", value) : "–";
}

}  // namespace

std::string to_table(const Result& result) {
  std::string text = fmt::format("{}: {} scans, {} detections, {} ego motions", result.method, result.scans,
                                 result.detections, result.ego_motions);
  if (result.scans > 0) text += fmt::format(", {:.1f} s", result.end_s - result.start_s);
  text += "\nabout the vehicle's axes:\n";
  constexpr std::size_t kName = 20, kAngle = 21;
  text += padded("radar", kName) + padded("yaw", kAngle) + padded("pitch", kAngle) + padded("roll", kAngle) +
          padded("RMSE m/s", 18) + padded("95 % after s", 17) + padded("µs/scan", 9) + "state\n";
  for (const RadarResult& r : result.radars) {
    const AlignmentEstimate& m = r.message;
    text += padded(fmt::format("{} {}", r.id, r.name), kName);
    text += padded(angle(m.vehicle_yaw_rad, r.stds[1], m.is_observable(alignment_axis::kVehicleYaw)), kAngle);
    text += padded(angle(m.vehicle_pitch_rad, r.stds[2], m.is_observable(alignment_axis::kVehiclePitch)), kAngle);
    text += padded(angle(m.vehicle_roll_rad, r.stds[3], m.is_observable(alignment_axis::kVehicleRoll)), kAngle);
    text += padded(mps(r.residuals.before.rmse_mps) + " → " + mps(r.residuals.after.rmse_mps), 18);
    const auto& t95 = m.kpis.seconds_to_95_percent;
    text += padded(seconds(t95[1]) + " / " + seconds(t95[2]) + " / " + seconds(t95[3]), 17);
    text += padded(std::isfinite(r.cpu_us_per_scan) ? fmt::format("{:.1f}", r.cpu_us_per_scan) : "–", 9);
    text += name_of(m.state);
    if (!r.step_changes.empty())
      text += fmt::format(", {} knock{}", r.step_changes.size(), r.step_changes.size() == 1 ? "" : "s");
    text += '\n';
    constexpr std::array<const char*, 3> kSensorAxes = {"alpha", "beta", "gamma"};
    for (std::size_t i = 0; i < r.support.size(); ++i) {
      text += padded("", kName) + kSensorAxes.at(i) + " " + r.support[i] + '\n';
    }
    if (r.truth) {
      const auto error = [&](std::size_t i) { return fmt::format("{:+.4f}°", r.truth->errors.at(i) * kDegrees); };
      text += padded("  error", kName) + padded(error(1), kAngle) + padded(error(2), kAngle) + error(3) + '\n';
    }
  }
  text += result.speed_scale_observable ? fmt::format("k_v {:.6f} ± {:.6f}", result.speed_scale, result.speed_scale_std)
                                        : "k_v not observable";
  if (result.true_speed_scale) text += fmt::format(" (error {:+.6f})", result.speed_scale - *result.true_speed_scale);
  if (!result.series.empty()) {
    const Sample& last = result.series.back();
    if (last.yaw_rate_bias_std_radps > 0.0) {
      text += fmt::format(", yaw-rate bias {:+.4f} ± {:.4f} °/s", last.yaw_rate_bias_radps * kDegrees,
                          last.yaw_rate_bias_std_radps * kDegrees);
    }
    if (last.slip_coefficient_std_radps2pm > 0.0) {
      text += fmt::format(", slip {:+.5f} ± {:.5f} rad/(m/s²)", last.slip_coefficient_radps2pm,
                          last.slip_coefficient_std_radps2pm);
    }
  }
  return text + '\n';
}

}  // namespace boresight::align
