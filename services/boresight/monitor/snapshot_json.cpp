// A snapshot as an object of JSON: config/schema/run.md, monitor.jsonl.
#include <cmath>

#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "services/boresight/monitor/snapshot.hpp"
#include "services/boresight/run/radar_json.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::monitor {

namespace {

/// With the digits of a float: most values of a snapshot come from such.
double digits_of(double value) {
  return json::shortest(static_cast<float>(value));
}

double degrees(double value_rad) {
  return digits_of(value_rad * kDegreesPerRadian);
}

json::Value estimate_of(const AngleEstimate& angle, double unit) {
  json::Value value;
  value["value"] = digits_of(angle.value_rad * unit);
  value["std"] = digits_of(angle.std_rad * unit);
  value["observable"] = angle.observable;
  return value;
}

void add_sensor_angle(json::Value& value, const std::string& name, const AngleEstimate& angle) {
  value[name + "_deg"] = degrees(angle.value_rad);
  value[name + "_std_deg"] = degrees(angle.std_rad);
  value[name + "_observable"] = angle.observable;
}

void add_details(json::Value& value, const AlignmentDetails& d) {
  value["vehicle_yaw_deg"] = estimate_of(d.yaw, kDegreesPerRadian);
  value["vehicle_pitch_deg"] = estimate_of(d.pitch, kDegreesPerRadian);
  value["vehicle_roll_deg"] = estimate_of(d.roll, kDegreesPerRadian);
  value["yaw_rate_bias_degps"] = estimate_of(d.yaw_rate_bias, kDegreesPerRadian);
  value["slip_coefficient_radps2pm"] = estimate_of(d.slip, 1.0);
  value["reason"] = d.reason;
  value["finding"] = d.finding;
  value["range_rate_scale"] = digits_of(d.range_rate_scale);
  value["range_rate_scale_std"] = digits_of(d.range_rate_scale_std);
  value["drift"] = d.drift;
  value["step_changes"] = d.step_changes;
  value["yaw_seconds_to_95_percent"] = digits_of(d.yaw_seconds_to_95_percent);
  value["pitch_seconds_to_95_percent"] = digits_of(d.pitch_seconds_to_95_percent);
  value["yaw_drift_degpmin"] = degrees(d.yaw_drift_radpmin);
  value["residual_rmse_mps"] = digits_of(d.residual_rmse_mps);
  value["nees"] = digits_of(d.nees);
}

/// Sums since the start of the monitor.
void add_labels(json::Value& value, const LabelCounts& labels) {
  json::Value& classified = value["classified"] = run::counts_by_origin(labels.classified);
  classified["rejected"] = labels.rejected;
  value["classified_scans"] = labels.scans;
  value["classified_without_tracks"] = labels.scans_without_tracks;
}

json::Value object_of(const RadarSnapshot& r) {
  json::Value value = run::radar_object(r.id, r.name);
  value["scans"] = r.scans;
  value["lost"] = r.lost;
  value["rate_hz"] = digits_of(r.rate_hz);
  value["detections"] = r.detections;
  value["moving"] = r.moving;
  value["ghosts"] = r.ghosts;
  value["state"] = name_of(r.state);
  add_sensor_angle(value, "yaw", r.yaw);
  add_sensor_angle(value, "pitch", r.pitch);
  add_sensor_angle(value, "roll", r.roll);
  value["yaw_tolerance_deg"] = degrees(r.yaw_tolerance_rad);
  value["speed_scale"] = digits_of(r.speed_scale);
  value["speed_scale_std"] = digits_of(r.speed_scale_std);
  value["data_qualifier"] = name_of(r.data_qualifier);
  value["extended_qualifier"] = name_of(r.extended_qualifier);
  value["explanation"] = r.explanation;
  for (std::size_t i = 0; i < kBeyondKeys.size(); ++i) value[kBeyondKeys[i]] = r.beyond_tolerance[i];
  value["missed"] = r.missed;
  value["suspect"] = r.suspect;
  value["conditions"] = words_of_conditions(r.conditions);
  value["condition_bits"] = r.conditions;
  add_details(value, r.details);
  add_labels(value, r.labels);
  return value;
}

json::Value object_of(const TrackSnapshot& t) {
  json::Value value;
  value["id"] = t.id;
  value["confirmed"] = t.confirmed;
  value["movement"] = name_of(t.movement);
  value["class"] = name_of(t.object_class);
  value["existence"] = digits_of(t.existence);
  value["mirror_probability"] = digits_of(t.mirror_probability);
  value["x_m"] = digits_of(t.x_m);
  value["y_m"] = digits_of(t.y_m);
  value["vx_mps"] = digits_of(t.vx_mps);
  value["vy_mps"] = digits_of(t.vy_mps);
  value["age_s"] = digits_of(t.age_s);
  return value;
}

json::Value object_of(const ServiceSnapshot& s) {
  json::Value value;
  value["name"] = catalogue::name_of(s.service);
  value["condition"] = name_of(s.condition);
  value["restarts"] = s.restarts;
  value["inputs"] = s.inputs;
  value["outputs"] = s.outputs;
  value["heap_allocations"] = s.heap_allocations;
  value["processing_max_us"] = digits_of(s.processing_max_us);
  value["latency_mean_us"] = digits_of(s.latency_mean_us);
  value["latency_max_us"] = digits_of(s.latency_max_us);
  json::Value& faults = value["faults"] = json::Value::object();
  for (std::size_t i = 0; i < kNumberOfFaults; ++i) {
    if (s.faults[i] != 0) faults[std::string(name_of(static_cast<Fault>(i)))] = s.faults[i];
  }
  return value;
}

json::Value object_of(const PipelineSnapshot& p) {
  json::Value value;
  value["data_qualifier"] = name_of(p.data_qualifier);
  json::Value& codes = value["failed_events"] = json::Value::array();
  for (const FailedEvent& event : failed_events_of(p)) codes.push_back(event.code);
  value["failed_event_bits"] = p.failed_events;
  value["lost_scans"] = p.lost_scans;
  value["budget_hits"] = p.budget_hits;
  value["queueing_max_ms"] = digits_of(p.queueing_max_ms);
  value["latency_p99_ms"] = digits_of(p.latency_p99_ms);
  return value;
}

json::Value object_of(const LatencyHistogram& histogram) {
  json::Value value;
  value["p50"] = std::round(histogram.percentile_us(0.5));
  value["p99"] = std::round(histogram.percentile_us(0.99));
  value["max"] = digits_of(histogram.max_us());
  json::Value& buckets = value["buckets"] = json::Value::array();
  for (std::size_t i = 0; i < LatencyHistogram::kBuckets; ++i) {
    if (histogram.counts()[i] != 0) buckets.push_back(json::Value::array({i, histogram.counts()[i]}));
  }
  return value;
}

template <typename Each>
json::Value array_of(const std::vector<Each>& values) {
  json::Value array = json::Value::array();
  for (const Each& each : values) array.push_back(object_of(each));
  return array;
}

}  // namespace

std::string to_json(const Snapshot& snapshot) {
  json::Value value;
  value["time_ns"] = snapshot.time_ns;
  value["ego_speed_mps"] = digits_of(snapshot.ego_speed_mps);
  value["ego_yaw_rate_radps"] = digits_of(snapshot.ego_yaw_rate_radps);
  value["track_lists"] = snapshot.track_lists;
  value["overall"] = name_of(snapshot.overall);
  value["pipeline"] = object_of(snapshot.pipeline);
  value["load_change"] = snapshot.load_change;
  value["speed_change"] = snapshot.speed_change;
  value["radars"] = array_of(snapshot.radars);
  value["tracks"] = array_of(snapshot.tracks);
  value["services"] = array_of(snapshot.services);
  json::Value& latencies = value["latency_us"];
  for (std::size_t i = 0; i < kNumberOfLatencies; ++i) {
    latencies[std::string(kLatencyNames[i])] = object_of(snapshot.latencies[i]);
  }
  return json::line(value);
}

}  // namespace boresight::monitor
