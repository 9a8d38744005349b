#include "services/boresight/run/summary.hpp"

#include <algorithm>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "services/boresight/run/radar_json.hpp"
#include "services/boresight/run/rows.hpp"

namespace boresight::run {

namespace {

constexpr int kRunFormat = 1;
constexpr std::array<const char*, scan_integrity::kNumberOfBits> kIntegrityNames = {
    "counter_gap", "repeated", "frozen", "stale", "implausible", "contradicts_ego", "incomplete", "impossible_copies"};

double seconds_of(std::int64_t time_ns) {
  return static_cast<double>(time_ns) / 1e9;
}

json::Value to_object(const Inputs& inputs) {
  json::Value object;
  if (inputs.recordings.empty()) {
    object["detections"] = inputs.detections;
    object["ego"] = inputs.ego;
  } else {
    object["recordings"] = inputs.recordings;
  }
  return object;
}

json::Value to_object(const Reasons& reasons) {
  json::Value object = json::Value::object();
  for (const auto& [reason, count] : reasons) object[reason] = count;
  return object;
}

json::Value counts_of(const RadarCounts& counts) {
  json::Value value;
  value["scans"] = counts.scans;
  value["detections"] = counts.detections;
  value["origins"] = counts_by_origin(counts.origins);
  value["alignment_estimates"] = counts.estimates;
  return value;
}

/// The losses that the counts of the scans state.
void add_losses_of_scans(const RadarCounts& counts, json::Value& value) {
  json::Value& integrity = value["scans_of_doubtful_integrity"] = json::Value::object();
  for (std::size_t i = 0; i < counts.integrity.size(); ++i) integrity[kIntegrityNames[i]] = counts.integrity[i];
  json::Value& lacking = value["scans_lacking_input"] = json::Value::object();
  for (std::size_t i = 0; i < counts.flags.size(); ++i) lacking[std::string(name_of_flag(i))] = counts.flags[i];
  value["dropped_detections"] = counts.dropped_detections;
  json::Value& rejections = value["rejected_detections"] = json::Value::object();
  const auto number = [&counts](Rejection reason) { return counts.rejections[static_cast<std::size_t>(reason)]; };
  rejections["invalid"] = number(Rejection::kInvalid);
  rejections["outside_region"] = number(Rejection::kOutsideRegion);
  rejections["weak"] = number(Rejection::kWeak);
}

json::Value losses_of(const RadarCounts& counts, const SourceStatistics& source, const Reasons& rejected,
                      const Reasons& noted) {
  json::Value value;
  value["missed_scans"] = source.lost;
  value["rejected_messages"] = to_object(rejected);
  value["noted_faults"] = to_object(noted);
  value["e2e_lost"] = source.e2e_lost;
  value["e2e_repeated"] = source.e2e_repeated;
  value["e2e_wrong"] = source.e2e_wrong;
  add_losses_of_scans(counts, value);
  return value;
}

json::Value losses_of(const RadarCounts& counts, const SensorHealth* health, std::uint64_t incomplete_scans) {
  json::Value value;
  if (health != nullptr) {
    value["missed_scans"] = health->missed_scans;
    value["e2e_lost"] = health->e2e_lost;
    value["e2e_repeated"] = health->e2e_repeated;
    value["e2e_wrong"] = health->e2e_wrong;
  }
  value["scans_not_recorded"] = incomplete_scans;
  add_losses_of_scans(counts, value);
  return value;
}

/// `losses(radar)` is the object "losses" of each radar.
template <typename Losses>
json::Value radars_of(const VehicleConfig& vehicle, const Counts& counts, const Losses& losses) {
  json::Value radars = json::Value::array();
  for (const RadarConfig& radar : vehicle.radars) {
    json::Value value = radar_object(radar.id, radar.name);
    value["counts"] = counts_of(counts.radars[radar.id]);
    value["losses"] = losses(radar.id);
    radars.push_back(value);
  }
  return radars;
}

json::Value totals_of(const Counts& counts) {
  std::uint64_t scans = 0, detections = 0, estimates = 0;
  for (const RadarCounts& radar : counts.radars) {
    scans += radar.scans;
    detections += radar.detections;
    estimates += radar.estimates;
  }
  json::Value value;
  value["ego_motions"] = counts.ego_motions;
  value["scans"] = scans;
  value["detections"] = detections;
  value["track_rows"] = counts.tracks;
  value["alignment_estimates"] = estimates;
  return value;
}

json::Value input_losses_of(const Summary& summary) {
  json::Value value;
  if (summary.frames) {
    value["frames"] = summary.frames->frames;
    value["unreadable"] = summary.frames->problems;
    value["error_frames"] = summary.frames->error_frames;
    value["ignored"] = summary.frames->ignored;
    value["backwards"] = summary.frames->backwards;
  }
  if (summary.tables) {
    value["lines"] = summary.tables->lines;
    value["unreadable"] = summary.tables->bad_lines;
    json::Value& unknown = value["lines_of_unknown_radars"] = json::Value::object();
    for (const auto& [id, lines] : summary.tables->unknown_radars) unknown[std::to_string(id)] = lines;
    value["dropped_detections"] = summary.tables->dropped_detections;
  }
  value["rejected_messages"] = to_object(summary.rejected[0]);
  value["noted_faults"] = to_object(summary.noted[0]);
  return value;
}

json::Value tracker_losses_of(const Counts& counts) {
  json::Value value;
  value["scans_out_of_order"] = counts.scans_out_of_order;
  value["restarts"] = counts.tracker_restarts;
  value["scans_at_work_budget"] = counts.tracker_at_budget;
  value["scans_with_cut_gates"] = counts.tracker_cut_gates;
  value["dropped_detections"] = counts.tracker_dropped_detections;
  value["dropped_objects"] = counts.tracker_dropped_objects;
  return value;
}

json::Value timing_of(const Timing& timing, double recording_s) {
  const StageTimes& t = timing.stages;
  const double known_s = seconds_of(t.estimator + t.corrector + t.ghost_filter + t.tracker + t.health) + timing.write_s;
  json::Value stages;
  stages["decode"] = std::max(0.0, timing.cpu_s - known_s);
  stages["alignment_estimator"] = seconds_of(t.estimator);
  stages["detection_corrector"] = seconds_of(t.corrector);
  stages["ghost_filter"] = seconds_of(t.ghost_filter);
  stages["tracker"] = seconds_of(t.tracker);
  stages["health"] = seconds_of(t.health);
  stages["write"] = timing.write_s;
  json::Value value;
  value["wall_s"] = timing.wall_s;
  value["cpu_s"] = timing.cpu_s;
  value["times_real_time"] = timing.wall_s > 0.0 ? json::Value(recording_s / timing.wall_s) : json::Value();
  value["cpu_s_by_stage"] = stages;
  return value;
}

}  // namespace

std::string to_json(const LiveSummary& summary, const VehicleConfig& vehicle) {
  const LiveResults& results = summary.results;
  json::Value value;
  value["tool"] = "boresight monitor";
  value["version"] = summary.version;
  value["format"] = kRunFormat;
  value["complete"] = true;
  value["continued"] = summary.is_continued;
  value["vehicle"]["file"] = summary.vehicle_file;
  value["vehicle"]["name"] = vehicle.name;
  value["configuration"]["folder"] = summary.configuration;
  value["clock"] = "CLOCK_MONOTONIC";
  value["epoch_offset_ns"] = summary.epoch_offset_ns;
  value["start_ns"] = results.start_ns();
  value["recording_s"] = seconds_of(results.length_ns());
  value["counts"] = totals_of(results.counts());
  value["radars"] = radars_of(vehicle, results.counts(), [&results](std::uint32_t id) {
    return losses_of(results.counts().radars[id], results.health_of(id), results.incomplete_scans()[id]);
  });
  return json::document(value);
}

std::string with_truth_begin(std::string_view run_json, std::int64_t truth_begin_ns) {
  json::Value value = json::Value::parse(run_json, nullptr, false);
  if (!value.is_object()) throw std::invalid_argument("run.json is no JSON object");
  value["truth_begin_ns"] = truth_begin_ns;
  return json::document(value);
}

std::string to_json(const Summary& summary, const VehicleConfig& vehicle) {
  json::Value value;
  value["tool"] = "boresight run";
  value["version"] = summary.inputs.version;
  value["format"] = kRunFormat;
  value["complete"] = summary.is_complete;
  value["inputs"] = to_object(summary.inputs);
  value["vehicle"]["file"] = summary.inputs.vehicle_file;
  value["vehicle"]["name"] = vehicle.name;
  value["configuration"]["folder"] = summary.inputs.configuration;
  for (const auto& [service, file] : summary.inputs.settings_files) value["configuration"][service] = file;
  value["start_ns"] = summary.start_ns;
  value["recording_s"] = summary.recording_s;
  value["counts"] = totals_of(summary.counts);
  value["radars"] = radars_of(vehicle, summary.counts, [&summary](std::uint32_t id) {
    return losses_of(summary.counts.radars[id], summary.sources[id], summary.rejected[id], summary.noted[id]);
  });
  value["losses"]["input"] = input_losses_of(summary);
  value["losses"]["tracker"] = tracker_losses_of(summary.counts);
  value["timing"] = timing_of(summary.timing, summary.recording_s);
  return json::document(value);
}

}  // namespace boresight::run
