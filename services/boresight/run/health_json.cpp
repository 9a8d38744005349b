// A line of health.jsonl.
#include <nlohmann/json.hpp>

#include "interfaces/messages/names.hpp"
#include "services/boresight/json/text.hpp"
#include "services/boresight/run/writer.hpp"
#include "services/common/alignment_words/alignment_words.hpp"

namespace boresight::run {

namespace {

json::Value to_json(const AxisHealth& axis) {
  json::Value value;
  value["error_rad"] = json::shortest(axis.error_rad);
  value["std_rad"] = json::shortest(axis.std_rad);
  value["tolerance_rad"] = json::shortest(axis.tolerance_rad);
  value["limit_rad"] = json::shortest(axis.limit_rad);
  value["beyond_tolerance_probability"] = json::shortest(axis.beyond_tolerance_probability);
  value["beyond_limit_probability"] = json::shortest(axis.beyond_limit_probability);
  value["observable"] = axis.observable != 0;
  value["beyond_tolerance"] = axis.beyond_tolerance != 0;
  value["about_vehicle_axis"] = axis.about_vehicle_axis != 0;
  value["effect"] = name_of(axis.effect);
  return value;
}

json::Value to_json(const AlignmentDrift& drift, std::int64_t start_ns) {
  json::Value value;
  value["since_s"] =
      drift.since_ns == 0 ? json::Value() : json::Value(static_cast<double>(drift.since_ns - start_ns) / 1e9);
  value["yaw_radps"] = json::shortest(drift.yaw_radps);
  value["yaw_std_radps"] = json::shortest(drift.yaw_std_radps);
  value["pitch_radps"] = json::shortest(drift.pitch_radps);
  value["pitch_std_radps"] = json::shortest(drift.pitch_std_radps);
  return value;
}

json::Value to_json(const AlignmentVehicleChange& change, const char* size, std::int64_t start_ns) {
  json::Value value;
  value["t_s"] =
      change.time_ns == 0 ? json::Value() : json::Value(static_cast<double>(change.time_ns - start_ns) / 1e9);
  value[size] = json::shortest(change.size);
  value["count"] = change.count;
  return value;
}

json::Value to_json(const SensorHealth& sensor, const VehicleConfig& vehicle, std::int64_t start_ns) {
  json::Value value;
  value["radar"] = sensor.radar_id;
  value["data_qualifier"] = name_of(sensor.data_qualifier);
  value["extended_qualifier"] = name_of(sensor.extended_qualifier);
  value["explanation"] = alignment_words::explanation_of(sensor, vehicle);
  value["reason"] = alignment_words::key_of(sensor.reason);
  value["finding"] = alignment_words::key_of(sensor.finding);
  value["finding_value"] = json::shortest(sensor.finding_value);
  value["finding_radar"] = sensor.finding_radar;
  value["conditions"] = words_of_conditions(sensor.conditions);
  value["rate_hz"] = json::shortest(sensor.rate_hz);
  value["expected_rate_hz"] = json::shortest(sensor.expected_rate_hz);
  value["last_seen_s"] = sensor.last_seen_s < 0.0F ? json::Value() : json::Value(json::shortest(sensor.last_seen_s));
  value["detections_per_scan"] = json::shortest(sensor.detections_per_scan);
  value["yaw"] = to_json(sensor.yaw);
  value["pitch"] = to_json(sensor.pitch);
  value["roll"] = to_json(sensor.roll);
  value["speed_scale"] = json::shortest(sensor.speed_scale);
  value["speed_scale_std"] = json::shortest(sensor.speed_scale_std);
  value["range_rate_scale"] = json::shortest(sensor.range_rate_scale.value);
  value["range_rate_scale_std"] = json::shortest(sensor.range_rate_scale.std);
  value["drift"] = to_json(sensor.drift, start_ns);
  value["lateral_displacement_m"] = json::shortest(sensor.lateral_displacement_m);
  value["reference_range_m"] = json::shortest(sensor.reference_range_m);
  value["lost_coverage_ratio"] = json::shortest(sensor.lost_coverage_ratio);
  value["range_loss_ratio"] = json::shortest(sensor.range_loss_ratio);
  value["velocity_error_mps"] = json::shortest(sensor.velocity_error_mps);
  value["step_changes"] = sensor.step_changes;
  value["scans"] = sensor.scans;
  value["missed_scans"] = sensor.missed_scans;
  value["suspect_scans"] = sensor.suspect_scans;
  value["e2e_lost"] = sensor.e2e_lost;
  value["e2e_repeated"] = sensor.e2e_repeated;
  value["e2e_wrong"] = sensor.e2e_wrong;
  return value;
}

}  // namespace

std::string to_json_line(const HealthResult& result, const VehicleConfig& vehicle) {
  json::Value value;
  value["t_s"] = static_cast<double>(result.at.since_start_us()) / 1e6;
  value["time_ns"] = result.at.time_ns;
  value["overall"] = name_of(result.overall);
  value["load_change"] = to_json(result.load_change, "pitch_rad", result.at.start_ns);
  value["speed_change"] = to_json(result.speed_change, "scale", result.at.start_ns);
  json::Value& radars = value["radars"] = json::Value::array();
  for (std::size_t i = 0; i < result.number_of_sensors; ++i)
    radars.push_back(to_json(result.sensors[i], vehicle, result.at.start_ns));
  return json::line(value);
}

}  // namespace boresight::run
