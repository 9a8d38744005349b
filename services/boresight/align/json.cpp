#include "services/boresight/align/json.hpp"

#include <cmath>

#include "services/boresight/align/json_writer.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::align {

namespace {

constexpr std::array<const char*, kParameters> kNames = {"k_v", "yaw", "pitch", "roll"};
constexpr std::array<const char*, 3> kSensorNames = {"alpha", "beta", "gamma"};
constexpr std::array<std::uint32_t, kParameters> kVehicleBits = {
    alignment_axis::kSpeedScale, alignment_axis::kVehicleYaw, alignment_axis::kVehiclePitch,
    alignment_axis::kVehicleRoll};
constexpr std::array<std::uint32_t, 3> kSensorBits = {alignment_axis::kYaw, alignment_axis::kPitch,
                                                      alignment_axis::kRoll};

/// k_v as it is, angles in degrees.
double shown(std::size_t parameter, double value) {
  return parameter == 0 ? value : value * kDegreesPerRadian;
}

std::string key_of(std::size_t parameter, const std::string& suffix = "") {
  return kNames.at(parameter) + suffix + (parameter == 0 ? "" : "_deg");
}

double std_of(const std::array<float, 16>& covariance, std::size_t i) {
  return std::sqrt(static_cast<double>(covariance.at(5 * i)));
}

void write_estimated(JsonWriter& json, const char* key, double value, double std, bool observable) {
  json.key(key).begin_object().field("value", value).field("std", std).field("observable", observable).end_object();
}

void write_moments(JsonWriter& json, const char* key, const Moments& moments) {
  json.key(key).begin_object().field("rmse_mps", moments.rmse_mps);
  json.field("skewness", moments.skewness).field("kurtosis", moments.kurtosis).end_object();
}

void write_observability(JsonWriter& json, const AlignmentEstimate& message) {
  const auto each = [&](const auto& write) {
    for (std::size_t i = 0; i < kParameters; ++i) write(kNames.at(i), message.is_observable(kVehicleBits.at(i)));
    for (std::size_t i = 0; i < 3; ++i) write(kSensorNames.at(i), message.is_observable(kSensorBits.at(i)));
  };
  json.key("observable").begin_object();
  each([&](const char* name, bool observable) { json.field(name, observable); });
  json.end_object().key("observability").begin_object();
  each([&](const char* name, bool observable) { json.field(name, observable ? "OBSERVABLE" : "NOT_OBSERVABLE"); });
  json.end_object();
}

void write_residuals(JsonWriter& json, const ResidualSummary& residuals) {
  json.key("residual").begin_object();
  write_moments(json, "corrected", residuals.after);
  write_moments(json, "uncorrected", residuals.before);
  json.field("inlier_ratio", residuals.inlier_ratio).field("detections", residuals.judged).end_object();
}

void write_truth(JsonWriter& json, const TruthComparison& truth) {
  json.key("truth").begin_object();
  for (std::size_t i = 0; i < kParameters; ++i)
    json.field(key_of(i), shown(i, truth.mountings[truth.true_now].values.at(i)));
  for (std::size_t i = 0; i < kParameters; ++i) json.field(key_of(i, "_error"), shown(i, truth.errors.at(i)));
  for (std::size_t i = 0; i < 3; ++i) {
    json.field(std::string(kSensorNames.at(i)) + "_error_deg", truth.sensor_errors_rad.at(i) * kDegreesPerRadian);
  }
  json.key("nees").begin_object();
  for (std::size_t i = 0; i < kParameters; ++i) json.field(kNames.at(i), truth.nees.at(i));
  json.end_object().key("seconds_to_95_percent").begin_object();
  for (std::size_t i = 0; i < kParameters; ++i) json.field(kNames.at(i), truth.seconds_to_95_percent.at(i));
  json.end_object().key("step_changes").begin_array();
  for (std::size_t i = 1; i < truth.mountings.size(); ++i) json.value(truth.mountings[i].from_s);
  json.end_array().end_object();
}

void write_radar(JsonWriter& json, const RadarResult& radar) {
  const AlignmentEstimate& m = radar.message;
  json.begin_object();
  json.field("id", std::uint64_t{radar.id}).field("name", radar.name).field("state", name_of(m.state));
  json.field("measures_elevation", radar.measures_elevation);
  const std::array<double, kParameters> vehicle = {radar.estimate.speed_scale, m.vehicle_yaw_rad, m.vehicle_pitch_rad,
                                                   m.vehicle_roll_rad};
  for (std::size_t i = 0; i < kParameters; ++i) {
    json.field(key_of(i), shown(i, vehicle.at(i)));
    json.field(key_of(i, "_std"), shown(i, radar.stds.at(i)));
  }
  const std::array<double, 3> sensor = {m.alignment_yaw_rad, m.alignment_pitch_rad, m.alignment_roll_rad};
  for (std::size_t i = 0; i < 3; ++i) {
    json.field(std::string(kSensorNames.at(i)) + "_deg", sensor.at(i) * kDegreesPerRadian);
    json.field(std::string(kSensorNames.at(i)) + "_std_deg", std_of(m.covariance, i + 1) * kDegreesPerRadian);
  }
  write_observability(json, m);
  const Eigen::Vector3d turn =
      geometry::so3_log(geometry::fixed_axes_rotation(m.vehicle_yaw_rad, m.vehicle_pitch_rad, m.vehicle_roll_rad));
  json.key("rotation_vector_vehicle_rad").begin_array();
  json.value(turn.x()).value(turn.y()).value(turn.z());
  json.end_array().key("sensor_to_vehicle").begin_array();
  for (Eigen::Index i = 0; i < 9; ++i) json.value(radar.estimate.sensor_to_vehicle(i / 3, i % 3));
  json.end_array().key("covariance").begin_array();
  for (Eigen::Index i = 0; i < 16; ++i) json.value(radar.estimate.covariance(i / 4, i % 4));
  json.end_array();
  write_residuals(json, radar.residuals);
  json.key("seconds_to_95_percent").begin_object();
  for (std::size_t i = 0; i < kParameters; ++i) {
    json.field(kNames.at(i), double{m.kpis.seconds_to_95_percent.at(i)});
  }
  json.end_object().key("scans_to_95_percent").begin_object();
  for (std::size_t i = 0; i < kParameters; ++i) {
    const std::uint32_t scans = m.kpis.scans_to_95_percent.at(i);
    json.field(kNames.at(i), scans == 0 ? std::nan("") : static_cast<double>(scans));
  }
  json.end_object();
  json.field("cpu_us_per_scan", radar.cpu_us_per_scan).field("max_cpu_us_per_scan", radar.max_cpu_us_per_scan);
  json.field("scans", radar.scans).field("scans_used", radar.estimate.scans_used);
  json.field("scans_without_ego_motion", radar.scans_without_ego);
  json.field("detections", radar.detections).field("detections_used", radar.estimate.detections_used);
  json.field("seconds_of_drive", radar.estimate.seconds_of_drive);
  json.field("angle_noise_scale", radar.estimate.angle_noise_scale);
  json.key("step_changes").begin_array();
  for (const StepChangeEvent& step_change : radar.step_changes) {
    json.begin_object().field("t", step_change.time_s);
    for (std::size_t i = 0; i < 3; ++i)
      json.field(key_of(i + 1), step_change.yaw_pitch_roll_rad.at(i) * kDegreesPerRadian);
    json.end_object();
  }
  json.end_array();
  if (!radar.support.empty()) {
    json.key("support").begin_object();
    for (std::size_t i = 0; i < radar.support.size(); ++i) json.field(kSensorNames.at(i), radar.support[i]);
    json.end_object();
  }
  if (radar.truth) write_truth(json, *radar.truth);
  json.end_object();
}

void write_series(JsonWriter& json, const Result& result) {
  const auto column = [&](const char* key, const auto& value) {
    json.key(key).begin_array();
    for (const Sample& sample : result.series) json.value(value(sample));
    json.end_array();
  };
  json.key("time_series").begin_object();
  column(result.x_is_iteration ? "iteration" : "t", [](const Sample& s) { return s.x; });
  column("k_v", [](const Sample& s) { return s.speed_scale; });
  column("k_v_std", [](const Sample& s) { return s.speed_scale_std; });
  column("yaw_rate_bias_radps", [](const Sample& s) { return s.yaw_rate_bias_radps; });
  column("yaw_rate_bias_std_radps", [](const Sample& s) { return s.yaw_rate_bias_std_radps; });
  column("slip_coefficient_radps2pm", [](const Sample& s) { return s.slip_coefficient_radps2pm; });
  column("slip_coefficient_std_radps2pm", [](const Sample& s) { return s.slip_coefficient_std_radps2pm; });
  json.key("radars").begin_array();
  for (std::size_t r = 0; r < result.radars.size(); ++r) {
    json.begin_object().field("id", std::uint64_t{result.radars[r].id});
    column("state", [r](const Sample& s) { return name_of(s.radars[r].state); });
    for (std::size_t i = 0; i < kParameters; ++i) {
      column(key_of(i).c_str(), [r, i](const Sample& s) { return shown(i, s.radars[r].values.at(i)); });
      column(key_of(i, "_std").c_str(), [r, i](const Sample& s) { return shown(i, s.radars[r].stds.at(i)); });
      column((std::string(kNames.at(i)) + "_observable").c_str(),
             [r, i](const Sample& s) { return (s.radars[r].observable & kVehicleBits.at(i)) != 0; });
    }
    json.end_object();
  }
  json.end_array().end_object();
}

}  // namespace

const char* name_of(AlignmentState state) {
  switch (state) {
    case AlignmentState::kNoData:
      return "NO_DATA";
    case AlignmentState::kWaiting:
      return "WAITING";
    case AlignmentState::kConverging:
      return "CONVERGING";
    case AlignmentState::kConverged:
      return "CONVERGED";
  }
  return "UNKNOWN";
}

std::string to_json(const Result& result, const Provenance& provenance) {
  JsonWriter json;
  json.begin_object().field("tool", "boresight align").field("version", provenance.tool_version);
  json.field("format", std::uint64_t{1}).field("method", result.method).field("vehicle", result.vehicle);
  json.key("inputs").begin_object();
  const auto file = [&](const char* key, const std::string& name) {
    if (!name.empty()) json.field(key, name);
  };
  file("drive", provenance.drive);
  file("ego", provenance.ego);
  if (!provenance.recordings.empty()) {
    json.key("recordings").begin_array();
    for (const std::string& name : provenance.recordings) json.value(name);
    json.end_array();
  }
  file("vehicle", provenance.vehicle);
  file("config", provenance.config);
  file("truth", provenance.truth);
  json.end_object().key("recording").begin_object();
  json.field("start_s", result.start_s).field("end_s", result.end_s).field("duration_s", result.end_s - result.start_s);
  json.field("scans", result.scans).field("detections", result.detections).field("ego_motions", result.ego_motions);
  json.field("dropped_detections", provenance.dropped_detections);
  json.field("lines", provenance.lines).field("bad_lines", provenance.bad_lines).end_object();

  write_estimated(json, "k_v", result.speed_scale, result.speed_scale_std, result.speed_scale_observable);
  const Sample last = result.series.empty() ? Sample{} : result.series.back();
  std::uint32_t bits = 0;
  for (const RadarResult& radar : result.radars) bits |= radar.message.observable;
  write_estimated(json, "yaw_rate_bias_radps", last.yaw_rate_bias_radps, last.yaw_rate_bias_std_radps,
                  (bits & alignment_axis::kYawRateBias) != 0);
  write_estimated(json, "slip_coefficient_radps2pm", last.slip_coefficient_radps2pm, last.slip_coefficient_std_radps2pm,
                  (bits & alignment_axis::kSlip) != 0);
  if (!result.speed_scale_support.empty()) json.field("k_v_support", result.speed_scale_support);
  if (result.true_speed_scale) json.field("k_v_error", result.speed_scale - *result.true_speed_scale);
  json.key("radars").begin_array();
  for (const RadarResult& radar : result.radars) write_radar(json, radar);
  json.end_array();
  write_series(json, result);
  json.end_object();
  return json.text() + "\n";
}

}  // namespace boresight::align
