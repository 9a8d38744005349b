#include "services/boresight/diagnostics/alignment_text.hpp"

#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "interfaces/messages/names.hpp"
#include "services/boresight/diagnostics/sample_time.hpp"
#include "services/boresight/json/text.hpp"
#include "services/common/alignment_words/alignment_words.hpp"
#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"
#include "services/common/text/printable.hpp"

namespace boresight::diagnostics_text {

namespace {

constexpr std::array<std::string_view, kNumberOfAlignmentParameters> kParameterKeys = {"speed_scale", "yaw", "pitch",
                                                                                       "roll"};
constexpr std::size_t kRadarColumns = 13;

template <typename Covariance>
double std_of(const Covariance& covariance, AlignmentParameter parameter) {
  const auto i = static_cast<std::size_t>(parameter);
  return std::sqrt(static_cast<double>(covariance[i * kNumberOfAlignmentParameters + i]));
}

template <typename Numbers>
json::Value floats_of(const Numbers& values) {
  json::Value array = json::Value::array();
  for (const float value : values) array.push_back(json::shortest(value));
  return array;
}

json::Value value_object(const diagnostics::EstimatedValue& value) {
  json::Value object;
  object["value"] = json::shortest(value.value());
  object["std"] = json::shortest(value.std());
  return object;
}

json::Value change_object(const diagnostics::VehicleChange& change) {
  json::Value object;
  object["time_ns"] = change.time_ns();
  object["size"] = json::shortest(change.size());
  object["count"] = change.count();
  return object;
}

json::Value nuisance_object(const diagnostics::NuisanceParameters& n) {
  json::Value object;
  object["range_rate_scale"] = value_object(n.range_rate_scale());
  object["time_offset_s"] = value_object(n.time_offset_s());
  object["position_x_m"] = value_object(n.position_x_m());
  object["position_y_m"] = value_object(n.position_y_m());
  object["yaw_rate_gain"] = value_object(n.yaw_rate_gain());
  object["pitch_per_acceleration_radps2pm"] = value_object(n.pitch_per_acceleration_radps2pm());
  object["load_pitch_rad"] = value_object(n.load_pitch_rad());
  object["yaw_scatter_rad"] = json::shortest(n.yaw_scatter_rad());
  object["pitch_scatter_rad"] = json::shortest(n.pitch_scatter_rad());
  object["azimuth_curve_rad"] = floats_of(n.azimuth_curve_rad());
  object["azimuth_curve_std_rad"] = floats_of(n.azimuth_curve_std_rad());
  object["azimuth_curve_first_rad"] = json::shortest(n.azimuth_curve_first_rad());
  object["azimuth_curve_step_rad"] = json::shortest(n.azimuth_curve_step_rad());
  object["observable"] = n.observable();
  object["range_rate_noise_scale"] = json::shortest(n.range_rate_noise_scale());
  return object;
}

json::Value kpi_object(const diagnostics::AlignmentKpis& k) {
  json::Value object;
  object["residual_rmse_mps"] = json::shortest(k.residual_rmse_mps());
  object["uncorrected_residual_rmse_mps"] = json::shortest(k.uncorrected_residual_rmse_mps());
  object["residual_skewness"] = json::shortest(k.residual_skewness());
  object["residual_kurtosis"] = json::shortest(k.residual_kurtosis());
  object["inlier_ratio"] = json::shortest(k.inlier_ratio());
  object["seconds_of_drive"] = json::shortest(k.seconds_of_drive());
  for (std::size_t i = 0; i < kParameterKeys.size(); ++i) {
    const std::string key(kParameterKeys[i]);
    object["seconds_to_95_percent"][key] = json::shortest(k.seconds_to_95_percent()[i]);
    object["scans_to_95_percent"][key] = k.scans_to_95_percent()[i];
    object["drift_per_minute"][key] = json::shortest(k.drift_per_minute()[i]);
  }
  object["nees"] = json::shortest(k.nees());
  object["scans_used"] = k.scans_used();
  object["detections_used"] = k.detections_used();
  return object;
}

}  // namespace

std::string to_line(const diagnostics::AlignmentEstimate& e) {
  std::string line =
      fmt::format("{} {}{}", shown_time(e.time_ns()), text::padded(text::printable(e.radar_name()), kRadarColumns),
                  name_of(static_cast<AlignmentState>(e.state())));
  const auto reason = static_cast<AlignmentReason>(e.reason());
  if (reason != AlignmentReason::kNone) line += fmt::format(": {}", alignment_words::words_of(reason));
  if (e.finding() != diagnostics::FINDING_NONE) {
    line += fmt::format("  wrong input {}", alignment_words::key_of(static_cast<AlignmentFinding>(e.finding())));
  }
  const auto add = [&](std::string_view name, std::uint32_t bit, float value, const auto& covariance,
                       AlignmentParameter parameter, std::string_view axes) {
    if ((e.observable() & bit) == 0) return;
    line += fmt::format("  {} {}{}", name, alignment_words::angle_text(value, std_of(covariance, parameter)), axes);
  };
  using enum AlignmentParameter;
  add("yaw", alignment_axis::kYaw, e.alignment_yaw_rad(), e.covariance(), kYaw, "");
  add("pitch", alignment_axis::kPitch, e.alignment_pitch_rad(), e.covariance(), kPitch, "");
  add("roll", alignment_axis::kRoll, e.alignment_roll_rad(), e.covariance(), kRoll, "");
  add("yaw", alignment_axis::kVehicleYaw, e.vehicle_yaw_rad(), e.vehicle_covariance(), kYaw, " (vehicle's axis)");
  add("pitch", alignment_axis::kVehiclePitch, e.vehicle_pitch_rad(), e.vehicle_covariance(), kPitch,
      " (vehicle's axis)");
  add("roll", alignment_axis::kVehicleRoll, e.vehicle_roll_rad(), e.vehicle_covariance(), kRoll, " (vehicle's axis)");
  line += "  speed scale " + text::with_std(e.speed_scale(), std_of(e.covariance(), kSpeedScale));
  if (e.step_change().count() > 0) line += fmt::format("  sudden changes {}", e.step_change().count());
  return line;
}

std::string to_json(const diagnostics::AlignmentEstimate& e) {
  json::Value object;
  object["radar_id"] = e.radar_id();
  object["radar"] = e.radar_name();
  object["vehicle"] = e.vehicle_name();
  object["time_ns"] = e.time_ns();
  object["measurement_time_ns"] = e.measurement_time_ns();
  object["layout_version"] = e.layout_version();
  object["sequence_number"] = e.sequence_number();
  object["radar_sequence_number"] = e.radar_sequence_number();
  object["state"] = name_of(static_cast<AlignmentState>(e.state()));
  object["reason"] = alignment_words::key_of(static_cast<AlignmentReason>(e.reason()));
  object["finding"] = alignment_words::key_of(static_cast<AlignmentFinding>(e.finding()));
  object["finding_value"] = json::shortest(e.finding_value());
  object["finding_radar"] = e.finding_radar();
  object["observable"] = e.observable();
  object["speed_scale"] = json::shortest(e.speed_scale());
  object["alignment_yaw_rad"] = json::shortest(e.alignment_yaw_rad());
  object["alignment_pitch_rad"] = json::shortest(e.alignment_pitch_rad());
  object["alignment_roll_rad"] = json::shortest(e.alignment_roll_rad());
  object["vehicle_yaw_rad"] = json::shortest(e.vehicle_yaw_rad());
  object["vehicle_pitch_rad"] = json::shortest(e.vehicle_pitch_rad());
  object["vehicle_roll_rad"] = json::shortest(e.vehicle_roll_rad());
  object["yaw_rate_bias_radps"] = json::shortest(e.yaw_rate_bias_radps());
  object["yaw_rate_bias_std_radps"] = json::shortest(e.yaw_rate_bias_std_radps());
  object["slip_coefficient_radps2pm"] = json::shortest(e.slip_coefficient_radps2pm());
  object["slip_coefficient_std_radps2pm"] = json::shortest(e.slip_coefficient_std_radps2pm());
  object["angle_noise_scale"] = json::shortest(e.angle_noise_scale());
  object["covariance"] = floats_of(e.covariance());
  object["vehicle_covariance"] = floats_of(e.vehicle_covariance());
  object["step_change"]["time_ns"] = e.step_change().time_ns();
  object["step_change"]["rotation_vehicle_rad"] = floats_of(e.step_change().rotation_vehicle_rad());
  object["step_change"]["count"] = e.step_change().count();
  object["load_change"] = change_object(e.load_change());
  object["speed_change"] = change_object(e.speed_change());
  object["drift"]["since_ns"] = e.drift().since_ns();
  object["drift"]["yaw_radps"] = json::shortest(e.drift().yaw_radps());
  object["drift"]["yaw_std_radps"] = json::shortest(e.drift().yaw_std_radps());
  object["drift"]["pitch_radps"] = json::shortest(e.drift().pitch_radps());
  object["drift"]["pitch_std_radps"] = json::shortest(e.drift().pitch_std_radps());
  object["nuisance"] = nuisance_object(e.nuisance());
  object["kpis"] = kpi_object(e.kpis());
  return json::line(object);
}

}  // namespace boresight::diagnostics_text
