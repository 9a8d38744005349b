#include "services/boresight/align/json.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "services/common/alignment_words/alignment_words.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::align {

namespace {

using json::significant;

constexpr std::array<const char*, kParameters> kNames = {"k_v", "yaw", "pitch", "roll"};
constexpr std::array<const char*, 3> kSensorNames = {"alpha", "beta", "gamma"};
constexpr std::array<std::uint32_t, kParameters> kVehicleBits = {
    alignment_axis::kSpeedScale, alignment_axis::kVehicleYaw, alignment_axis::kVehiclePitch,
    alignment_axis::kVehicleRoll};
constexpr std::array<std::uint32_t, 3> kSensorBits = {alignment_axis::kYaw, alignment_axis::kPitch,
                                                      alignment_axis::kRoll};

double degrees(double angle_rad) {
  return significant(angle_rad * kDegreesPerRadian);
}

/// k_v as it is, angles in degrees.
double shown(std::size_t parameter, double value) {
  return parameter == 0 ? significant(value) : degrees(value);
}

std::string key_of(std::size_t parameter, const std::string& suffix = "") {
  return kNames.at(parameter) + suffix + (parameter == 0 ? "" : "_deg");
}

std::string sensor_key_of(std::size_t axis, const std::string& suffix = "") {
  return kSensorNames.at(axis) + suffix + "_deg";
}

double std_of(const std::array<float, 16>& covariance, std::size_t i) {
  return std::sqrt(static_cast<double>(covariance.at(5 * i)));
}

json::Value estimated(double value, double std, bool observable) {
  json::Value object;
  object["value"] = significant(value);
  object["std"] = significant(std);
  object["observable"] = observable;
  return object;
}

json::Value object_of(const Moments& moments) {
  json::Value object;
  object["rmse_mps"] = significant(moments.rmse_mps);
  object["skewness"] = significant(moments.skewness);
  object["kurtosis"] = significant(moments.kurtosis);
  return object;
}

json::Value object_of(const ResidualSummary& residuals) {
  json::Value object;
  object["corrected"] = object_of(residuals.after);
  object["uncorrected"] = object_of(residuals.before);
  object["inlier_ratio"] = significant(residuals.inlier_ratio);
  object["detections"] = residuals.judged;
  return object;
}

/// Keys k_v, yaw, pitch, roll.
template <typename Values>
json::Value by_parameter(const Values& values) {
  json::Value object;
  for (std::size_t i = 0; i < kParameters; ++i) object[kNames.at(i)] = significant(values.at(i));
  return object;
}

void add_observability(json::Value& object, const AlignmentEstimate& message) {
  json::Value observable, words;
  const auto add = [&](const char* name, std::uint32_t bits) {
    const bool is_observable = message.is_observable(bits);
    observable[name] = is_observable;
    words[name] = is_observable ? "OBSERVABLE" : "NOT_OBSERVABLE";
  };
  for (std::size_t i = 0; i < kParameters; ++i) add(kNames.at(i), kVehicleBits.at(i));
  for (std::size_t i = 0; i < 3; ++i) add(kSensorNames.at(i), kSensorBits.at(i));
  object["observable"] = std::move(observable);
  object["observability"] = std::move(words);
}

json::Value object_of(const TruthComparison& truth) {
  json::Value object;
  const TruthComparison::Mounting& now = truth.mountings[truth.true_now];
  for (std::size_t i = 0; i < kParameters; ++i) object[key_of(i)] = shown(i, now.values.at(i));
  for (std::size_t i = 0; i < kParameters; ++i) object[key_of(i, "_error")] = shown(i, truth.errors.at(i));
  for (std::size_t i = 0; i < 3; ++i) object[sensor_key_of(i, "_error")] = degrees(truth.sensor_errors_rad.at(i));
  object["nees"] = by_parameter(truth.nees);
  object["seconds_to_95_percent"] = by_parameter(truth.seconds_to_95_percent);
  json::Value& changes = object["step_changes"] = json::Value::array();
  for (std::size_t i = 1; i < truth.mountings.size(); ++i) changes.push_back(truth.mountings[i].from_s);
  return object;
}

/// Estimates with their standard deviations, about the axes of the vehicle and of the sensor.
void add_estimates(json::Value& object, const RadarResult& radar) {
  const AlignmentEstimate& m = radar.message;
  const std::array<double, kParameters> vehicle = {radar.estimate.speed_scale, m.vehicle_yaw_rad, m.vehicle_pitch_rad,
                                                   m.vehicle_roll_rad};
  for (std::size_t i = 0; i < kParameters; ++i) {
    object[key_of(i)] = shown(i, vehicle.at(i));
    object[key_of(i, "_std")] = shown(i, radar.stds.at(i));
  }
  const std::array<double, 3> sensor = {m.alignment_yaw_rad, m.alignment_pitch_rad, m.alignment_roll_rad};
  for (std::size_t i = 0; i < 3; ++i) {
    object[sensor_key_of(i)] = degrees(sensor.at(i));
    object[sensor_key_of(i, "_std")] = degrees(std_of(m.covariance, i + 1));
  }
  add_observability(object, m);
}

void add_matrices(json::Value& object, const RadarResult& radar) {
  const AlignmentEstimate& m = radar.message;
  const Eigen::Vector3d turn =
      geometry::so3_log(geometry::fixed_axes_rotation(m.vehicle_yaw_rad, m.vehicle_pitch_rad, m.vehicle_roll_rad));
  object["rotation_vector_vehicle_rad"] = {significant(turn.x()), significant(turn.y()), significant(turn.z())};
  json::Value& rotation = object["sensor_to_vehicle"] = json::Value::array();
  for (Eigen::Index i = 0; i < 9; ++i) rotation.push_back(significant(radar.estimate.sensor_to_vehicle(i / 3, i % 3)));
  json::Value& covariance = object["covariance"] = json::Value::array();
  for (Eigen::Index i = 0; i < 16; ++i) covariance.push_back(significant(radar.estimate.covariance(i / 4, i % 4)));
}

json::Value scans_to_95_percent_of(const AlignmentEstimate& message) {
  json::Value object;
  for (std::size_t i = 0; i < kParameters; ++i) {
    const std::uint32_t scans = message.kpis.scans_to_95_percent.at(i);
    object[kNames.at(i)] = scans == 0 ? json::Value() : json::Value(scans);
  }
  return object;
}

void add_counts(json::Value& object, const RadarResult& radar) {
  object["cpu_us_per_scan"] = significant(radar.cpu_us_per_scan);
  object["max_cpu_us_per_scan"] = significant(radar.max_cpu_us_per_scan);
  object["scans"] = radar.scans;
  object["scans_used"] = radar.estimate.scans_used;
  object["scans_without_ego_motion"] = radar.scans_without_ego;
  object["detections"] = radar.detections;
  object["detections_used"] = radar.estimate.detections_used;
  object["seconds_of_drive"] = significant(radar.estimate.seconds_of_drive);
  object["angle_noise_scale"] = significant(radar.estimate.angle_noise_scale);
  object["range_rate_noise_scale"] = significant(radar.estimate.nuisance.range_rate_noise_scale);
}

json::Value object_of(const StepChangeEvent& change) {
  json::Value object;
  object["t"] = change.time_s;
  for (std::size_t i = 0; i < 3; ++i) object[key_of(i + 1)] = degrees(change.yaw_pitch_roll_rad.at(i));
  return object;
}

void add_reason(json::Value& object, const RadarResult& radar) {
  const AlignmentEstimate& m = radar.message;
  object["reason"] = alignment_words::key_of(m.reason);
  object["reason_text"] = radar.reason;
  object["finding"] = alignment_words::key_of(m.finding);
  object["finding_text"] = radar.finding;
  object["finding_value"] =
      m.finding == AlignmentFinding::kNone ? json::Value() : json::Value(json::shortest(m.finding_value));
  object["finding_radar"] = m.finding_radar == 0 ? json::Value() : json::Value(m.finding_radar);
}

/// A value of the model with its standard deviation; no key where the method does not estimate it.
void add_value(json::Value& object, const char* key, const AlignmentValue& value, bool observable,
               double factor = 1.0) {
  if (!(value.std > 0.0F)) return;
  object[key] =
      estimated(factor * static_cast<double>(value.value), factor * static_cast<double>(value.std), observable);
}

json::Value curve_of(const AlignmentNuisance& n) {
  json::Value object;
  json::Value azimuths = json::Value::array(), errors = json::Value::array(), stds = json::Value::array();
  for (std::size_t k = 0; k < kAzimuthCurveKnots; ++k) {
    const float azimuth = n.azimuth_curve_first_rad + static_cast<float>(k) * n.azimuth_curve_step_rad;
    azimuths.push_back(degrees(static_cast<double>(azimuth)));
    errors.push_back(degrees(static_cast<double>(n.azimuth_curve_rad.at(k))));
    stds.push_back(degrees(static_cast<double>(n.azimuth_curve_std_rad.at(k))));
  }
  object["azimuth_deg"] = std::move(azimuths);
  object["error_deg"] = std::move(errors);
  object["error_std_deg"] = std::move(stds);
  object["observable"] = (n.observable & alignment_nuisance::kAzimuthCurve) != 0;
  return object;
}

/// What the model has of a radar beside its rotation.
void add_nuisances(json::Value& object, const RadarResult& radar) {
  const AlignmentNuisance& n = radar.message.nuisance;
  const auto add = [&](const char* key, const AlignmentValue& value, std::uint32_t bit) {
    add_value(object, key, value, (n.observable & bit) != 0);
  };
  add("range_rate_scale", n.range_rate_scale, alignment_nuisance::kRangeRateScale);
  add("time_offset_s", n.time_offset_s, alignment_nuisance::kTimeOffset);
  add("position_x_m", n.position_x_m, alignment_nuisance::kPositionX);
  add("position_y_m", n.position_y_m, alignment_nuisance::kPositionY);
  if (n.azimuth_curve_step_rad > 0.0F) object["azimuth_curve"] = curve_of(n);
  object["yaw_scatter_deg"] = degrees(static_cast<double>(n.yaw_scatter_rad));
  object["pitch_scatter_deg"] = degrees(static_cast<double>(n.pitch_scatter_rad));
  constexpr double kSecondsPerMinute = 60.0;
  const AlignmentDrift& drift = radar.message.drift;
  json::Value& of_drift = object["drift"];
  of_drift["since"] = radar.drift_since_s;
  const auto rate = [&](const char* key, float value) {
    of_drift[key] = degrees(kSecondsPerMinute * static_cast<double>(value));
  };
  rate("yaw_deg_per_min", drift.yaw_radps);
  rate("yaw_std_deg_per_min", drift.yaw_std_radps);
  rate("pitch_deg_per_min", drift.pitch_radps);
  rate("pitch_std_deg_per_min", drift.pitch_std_radps);
}

json::Value object_of(const MountingBefore& before) {
  json::Value object;
  for (std::size_t i = 1; i < kParameters; ++i) {
    object[key_of(i)] = degrees(before.values.at(i));
    object[key_of(i, "_std")] = degrees(before.stds.at(i));
  }
  return object;
}

json::Value object_of(const RadarResult& radar) {
  json::Value object;
  object["id"] = radar.id;
  object["name"] = radar.name;
  object["state"] = name_of(radar.message.state);
  add_reason(object, radar);
  object["measures_elevation"] = radar.measures_elevation;
  add_estimates(object, radar);
  add_matrices(object, radar);
  object["residual"] = object_of(radar.residuals);
  object["seconds_to_95_percent"] = by_parameter(radar.message.kpis.seconds_to_95_percent);
  object["scans_to_95_percent"] = scans_to_95_percent_of(radar.message);
  add_counts(object, radar);
  json::Value& changes = object["step_changes"] = json::Value::array();
  for (const StepChangeEvent& change : radar.step_changes) changes.push_back(object_of(change));
  if (radar.before_change) object["before_step_changes"] = object_of(*radar.before_change);
  add_nuisances(object, radar);
  for (std::size_t i = 0; i < radar.support.size(); ++i) object["support"][kSensorNames.at(i)] = radar.support[i];
  if (radar.truth) object["truth"] = object_of(*radar.truth);
  return object;
}

json::Value series_of(const Result& result) {
  const auto column = [&](const auto& value_of) {
    json::Value values = json::Value::array();
    for (const Sample& sample : result.series) values.push_back(value_of(sample));
    return values;
  };
  const auto numbers = [&](double Sample::*member) {
    return column([member](const Sample& s) { return significant(s.*member); });
  };
  json::Value series;
  series[result.x_is_iteration ? "iteration" : "t"] = column([](const Sample& s) { return s.x; });
  series["k_v"] = numbers(&Sample::speed_scale);
  series["k_v_std"] = numbers(&Sample::speed_scale_std);
  series["yaw_rate_bias_radps"] = numbers(&Sample::yaw_rate_bias_radps);
  series["yaw_rate_bias_std_radps"] = numbers(&Sample::yaw_rate_bias_std_radps);
  series["slip_coefficient_radps2pm"] = numbers(&Sample::slip_coefficient_radps2pm);
  series["slip_coefficient_std_radps2pm"] = numbers(&Sample::slip_coefficient_std_radps2pm);
  json::Value& radars = series["radars"] = json::Value::array();
  for (std::size_t r = 0; r < result.radars.size(); ++r) {
    json::Value object;
    object["id"] = result.radars[r].id;
    object["state"] = column([r](const Sample& s) { return name_of(s.radars[r].state); });
    for (std::size_t i = 0; i < kParameters; ++i) {
      object[key_of(i)] = column([r, i](const Sample& s) { return shown(i, s.radars[r].values.at(i)); });
      object[key_of(i, "_std")] = column([r, i](const Sample& s) { return shown(i, s.radars[r].stds.at(i)); });
      object[std::string(kNames.at(i)) + "_observable"] =
          column([r, i](const Sample& s) { return (s.radars[r].observable & kVehicleBits.at(i)) != 0; });
    }
    radars.push_back(std::move(object));
  }
  return series;
}

json::Value object_of(const Provenance& provenance) {
  json::Value object = json::Value::object();
  const auto file = [&](const char* key, const std::string& name) {
    if (!name.empty()) object[key] = name;
  };
  file("drive", provenance.drive);
  file("ego", provenance.ego);
  if (!provenance.recordings.empty()) object["recordings"] = provenance.recordings;
  file("vehicle", provenance.vehicle);
  file("config", provenance.config);
  file("truth", provenance.truth);
  return object;
}

json::Value recording_of(const Result& result, const Provenance& provenance) {
  json::Value object;
  object["start_s"] = result.start_s;
  object["end_s"] = result.end_s;
  object["duration_s"] = significant(result.end_s - result.start_s);
  object["scans"] = result.scans;
  object["detections"] = result.detections;
  object["ego_motions"] = result.ego_motions;
  object["dropped_detections"] = provenance.dropped_detections;
  object["lines"] = provenance.lines;
  object["bad_lines"] = provenance.bad_lines;
  return object;
}

/// Errors of the vehicle's signals, estimated with all radars.
void add_ego(json::Value& object, const Result& result) {
  object["k_v"] = estimated(result.speed_scale, result.speed_scale_std, result.speed_scale_observable);
  const Sample last = result.series.empty() ? Sample{} : result.series.back();
  std::uint32_t bits = 0;
  for (const RadarResult& radar : result.radars) bits |= radar.message.observable;
  object["yaw_rate_bias_radps"] =
      estimated(last.yaw_rate_bias_radps, last.yaw_rate_bias_std_radps, (bits & alignment_axis::kYawRateBias) != 0);
  object["slip_coefficient_radps2pm"] = estimated(last.slip_coefficient_radps2pm, last.slip_coefficient_std_radps2pm,
                                                  (bits & alignment_axis::kSlip) != 0);
  const AlignmentNuisance& vehicle = result.vehicle_nuisance;
  const auto add = [&](const char* key, const AlignmentValue& value, std::uint32_t bit, double factor) {
    add_value(object, key, value, (vehicle.observable & bit) != 0, factor);
  };
  add("yaw_rate_gain", vehicle.yaw_rate_gain, alignment_nuisance::kYawRateGain, 1.0);
  add("pitch_per_acceleration_radps2pm", vehicle.pitch_per_acceleration_radps2pm,
      alignment_nuisance::kPitchPerAcceleration, 1.0);
  add("load_pitch_deg", vehicle.load_pitch_rad, alignment_nuisance::kLoadPitch, kDegreesPerRadian);
  json::Value& loads = object["load_changes"] = json::Value::array();
  for (const VehicleChangeEvent& change : result.load_changes) {
    loads.push_back({{"t", change.time_s}, {"pitch_deg", degrees(change.size)}});
  }
  json::Value& speeds = object["speed_changes"] = json::Value::array();
  for (const VehicleChangeEvent& change : result.speed_changes) {
    speeds.push_back({{"t", change.time_s}, {"relative", significant(change.size)}});
  }
  if (!result.speed_scale_support.empty()) object["k_v_support"] = result.speed_scale_support;
  if (result.true_speed_scale) object["k_v_error"] = significant(result.speed_scale - *result.true_speed_scale);
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
  json::Value object;
  object["tool"] = "boresight align";
  object["version"] = provenance.tool_version;
  object["format"] = 1;
  object["method"] = result.method;
  object["vehicle"] = result.vehicle;
  object["inputs"] = object_of(provenance);
  object["recording"] = recording_of(result, provenance);
  object["problem"] = result.problem;
  if (result.batch) {
    json::Value& batch = object["batch"];
    batch["driven_s"] = significant(result.batch->driven_s);
    batch["windows"] = result.batch->windows;
    batch["passes"] = result.batch->passes;
    batch["settled"] = result.batch->settled;
  }
  add_ego(object, result);
  json::Value& radars = object["radars"] = json::Value::array();
  for (const RadarResult& radar : result.radars) radars.push_back(object_of(radar));
  object["time_series"] = series_of(result);
  return json::line(object);
}

}  // namespace boresight::align
