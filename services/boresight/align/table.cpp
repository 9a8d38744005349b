#include "services/boresight/align/table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "services/boresight/align/json.hpp"
#include "services/common/alignment_words/alignment_words.hpp"
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

/// "range-rate scale +0.00251 ± 0.00012"; "" where the method does not estimate the value.
std::string estimated(const char* name, const AlignmentValue& value, double factor, std::string_view unit) {
  if (!(value.std > 0.0F)) return "";
  return fmt::format("{} {}", name,
                     text::with_std(factor * static_cast<double>(value.value), factor * static_cast<double>(value.std),
                                    unit, text::Sign::kAlways));
}

std::string curve(const AlignmentNuisance& n) {
  if (!(n.azimuth_curve_step_rad > 0.0F)) return "";
  double squares = 0.0, variance = 0.0;
  for (std::size_t k = 0; k < kAzimuthCurveKnots; ++k) {
    squares += std::pow(static_cast<double>(n.azimuth_curve_rad.at(k)), 2) / kAzimuthCurveKnots;
    variance += std::pow(static_cast<double>(n.azimuth_curve_std_rad.at(k)), 2) / kAzimuthCurveKnots;
  }
  return "azimuth curve " +
         text::with_std(std::sqrt(squares) * kDegreesPerRadian, std::sqrt(variance) * kDegreesPerRadian, "° rms");
}

std::string joined(const std::vector<std::string>& parts) {
  std::string line;
  for (const std::string& part : parts) {
    if (!part.empty()) line += (line.empty() ? "" : ", ") + part;
  }
  return line;
}

/// What the model has of a radar beside its rotation; "" for other methods.
std::string nuisances(const RadarResult& radar) {
  const AlignmentNuisance& n = radar.message.nuisance;
  constexpr double kMilliseconds = 1e3, kCentimetres = 1e2, kPercent = 1e2;
  return joined({estimated("range-rate scale", n.range_rate_scale, kPercent, " %"),
                 estimated("time offset", n.time_offset_s, kMilliseconds, " ms"),
                 estimated("position x", n.position_x_m, kCentimetres, " cm"),
                 estimated("y", n.position_y_m, kCentimetres, " cm"), curve(n)});
}

std::string changes_of_vehicle(const Result& result) {
  std::string lines;
  for (const VehicleChangeEvent& change : result.load_changes) {
    lines += fmt::format("{:.1f} s: {}\n", change.time_s - result.start_s,
                         alignment_words::load_change_sentence({1, static_cast<float>(change.size), 1}));
  }
  for (const VehicleChangeEvent& change : result.speed_changes) {
    lines += fmt::format("{:.1f} s: {}\n", change.time_s - result.start_s,
                         alignment_words::speed_change_sentence({1, static_cast<float>(change.size), 1}));
  }
  return lines;
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
    const auto add_line = [&](const std::string& line) {
      if (!line.empty()) table += "  " + line + '\n';
    };
    add_line(r.reason);
    if (r.before_change) {
      const auto before = [&](std::size_t i) {
        return angle(r.before_change->values.at(i), r.before_change->stds.at(i), true);
      };
      table += padded("  before the change", name_width) + padded(before(1), kAngle) + padded(before(2), kAngle) +
               before(3) + '\n';
    }
    add_line(alignment_words::drift_sentence(m.drift));
    add_line(nuisances(r));
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
  const AlignmentNuisance& vehicle = result.vehicle_nuisance;
  constexpr double kPercent = 1e2;
  const std::string of_vehicle = joined(
      {estimated("yaw-rate gain", vehicle.yaw_rate_gain, kPercent, " %"),
       estimated("pitch by acceleration", vehicle.pitch_per_acceleration_radps2pm, kDegreesPerRadian, "°/(m/s²)"),
       result.load_changes.empty() ? "" : estimated("load pitch", vehicle.load_pitch_rad, kDegreesPerRadian, "°")});
  if (!of_vehicle.empty()) table += '\n' + of_vehicle;
  table += '\n' + changes_of_vehicle(result);
  if (result.batch) {
    table += fmt::format("{:.0f} s of driving in {} windows, read {} times{}\n", result.batch->driven_s,
                         result.batch->windows, result.batch->passes,
                         result.batch->settled ? "" : "; the solution still moved at the last time");
  }
  return table;
}

}  // namespace boresight::align
