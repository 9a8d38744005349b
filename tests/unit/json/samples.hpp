// What the writers of JSON write: for each section of config/schema/json.md objects that together have every key.
#pragma once

#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "services/boresight/align/json.hpp"
#include "services/boresight/calibrate/plate_report.hpp"
#include "services/boresight/calibrate/reflectors_report.hpp"
#include "services/boresight/diagnostics/alignment_text.hpp"
#include "services/boresight/diagnostics/diagnostics_text.hpp"
#include "services/boresight/diagnostics/fault_text.hpp"
#include "services/boresight/diagnostics/service_text.hpp"
#include "services/boresight/diagnostics/track_text.hpp"
#include "services/boresight/fit_evidence/report.hpp"
#include "services/boresight/json/text.hpp"
#include "services/boresight/monitor/snapshot.hpp"
#include "services/boresight/run/summary.hpp"
#include "services/boresight/run/writer.hpp"
#include "services/boresight/score/report_text.hpp"

namespace boresight::json::testing {

/// A name that every output must survive.
inline const std::string kName = "front \"long\", größte";

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

inline VehicleConfig one_radar() {
  VehicleConfig vehicle;
  vehicle.name = "car";
  vehicle.radars.resize(1);
  vehicle.radars[0].id = 1;
  vehicle.radars[0].name = kName;
  return vehicle;
}

inline std::vector<std::string> run_summaries() {
  run::Summary recordings;
  recordings.inputs.recordings = {"radars.pcap"};
  recordings.inputs.settings_files = {{"ingest_gateway", "i.toml"},
                                      {"alignment_estimator", "a.toml"},
                                      {"detection_corrector", "d.toml"},
                                      {"ghost_filter", "g.toml"},
                                      {"tracker", "t.toml"},
                                      {"object_classes", "o.toml"},
                                      {"object_forest", "f.csv"},
                                      {"health", "h.toml"}};
  recordings.frames = recording::Counts{};
  recordings.rejected[0] = recordings.noted[0] = recordings.rejected[1] = recordings.noted[1] = {{"wrong length", 3}};
  recordings.timing.wall_s = 2.0;
  run::Summary tables;
  tables.inputs.detections = tables.inputs.ego = "table.csv";
  tables.tables = run::TableLosses{};
  tables.tables->unknown_radars = {{9, 2}};

  run::LiveResults results({});
  EgoMotion ego{};
  ego.header.measurement_time_ns = 1;
  results.observe(ego);
  HealthReport report{};
  report.number_of_sensors = 1;
  report.sensors[0].radar_id = 1;
  results.observe(report);
  const std::string record = run::to_json({"1", "car.toml", "config", false, 5, results}, one_radar());
  return {run::to_json(recordings, one_radar()), run::to_json(tables, one_radar()), run::with_truth_begin(record, 7)};
}

inline std::vector<std::string> verdicts() {
  run::HealthResult never_seen;
  never_seen.number_of_sensors = 1;
  never_seen.sensors[0].last_seen_s = -1.0F;
  run::HealthResult seen = never_seen;
  seen.sensors[0].last_seen_s = 0.05F;
  never_seen.sensors[0].velocity_error_mps = std::nanf("");
  never_seen.sensors[0].yaw.limit_rad = INFINITY;
  seen.load_change.time_ns = seen.speed_change.time_ns = seen.sensors[0].drift.since_ns = 1;
  return {run::to_json_line(never_seen, one_radar()), run::to_json_line(seen, one_radar())};
}

inline std::vector<std::string> snapshots() {
  monitor::Snapshot snapshot;
  snapshot.radars.resize(2);
  snapshot.radars[0].name = kName;
  snapshot.pipeline.failed_events = 1;
  monitor::AlignmentDetails& known = snapshot.radars[1].details;
  known.yaw_seconds_to_95_percent = known.pitch_seconds_to_95_percent = known.yaw_drift_radpmin = 1.0;
  known.residual_rmse_mps = known.nees = 1.0;
  snapshot.tracks.resize(1);
  snapshot.services.resize(1);
  snapshot.services[0].faults[0] = 2;
  for (LatencyHistogram& histogram : snapshot.latencies) histogram.add(1000);
  return {monitor::to_json(snapshot)};
}

inline std::vector<std::string> scores() {
  score::NamedScore score;
  score.run = "my run";
  score.score.notes = {"a note"};
  score.score.figures.add("tracks.known", 1.0, "");
  score.score.figures.add("tracks.without_data", kUnknown, "");
  return {score::to_json({score}, "truth", "1")};
}

/// Without true objects there is no lane with perfect tracks.
inline std::vector<std::string> fits() {
  fit_evidence::Fit with_objects, without_objects;
  for (std::size_t lane = 0; lane < fit_evidence::kLanes; ++lane) {
    for (fit_evidence::Fit* const fit : {&with_objects, &without_objects}) {
      if (fit == &without_objects && lane == static_cast<std::size_t>(fit_evidence::Lane::kPerfect)) continue;
      fit_evidence::LaneScores& scores = fit->scores[lane];
      for (fit_evidence::Scores* const each : {&scores.base_rate, &scores.start, &scores.fitted}) each->add(0.5, true);
    }
  }
  with_objects.detections = without_objects.detections = 2;
  with_objects.real_detections = without_objects.real_detections = 1;
  const std::vector<fit_evidence::FittedDrive> drives = {{kName, "", kName, 3, 1, 2, 1, true}};
  return {fit_evidence::to_json(with_objects, drives, "radar.toml", "1"),
          fit_evidence::to_json(without_objects, drives, "", "1")};
}

/// Of one radar with nothing known.
inline align::Result unknown_alignment() {
  align::Result result;
  result.start_s = result.end_s = kUnknown;
  align::RadarResult& radar = result.radars.emplace_back();
  radar.id = 1;
  radar.name = kName;
  radar.cpu_us_per_scan = radar.max_cpu_us_per_scan = kUnknown;
  radar.residuals = {{kUnknown, kUnknown, kUnknown}, {kUnknown, kUnknown, kUnknown}, kUnknown, 0, {}};
  radar.message.kpis.seconds_to_95_percent.fill(std::nanf(""));
  align::TruthComparison truth;
  truth.mountings.resize(1);
  truth.mountings[0].values[0] = truth.errors[0] = kUnknown;
  truth.nees.fill(kUnknown);
  truth.seconds_to_95_percent.fill(kUnknown);
  radar.truth = truth;
  radar.drift_since_s = kUnknown;
  return result;
}

/// Every value is estimated.
inline AlignmentNuisance known_nuisance() {
  AlignmentNuisance n{};
  for (AlignmentValue* const value : {&n.range_rate_scale, &n.time_offset_s, &n.position_x_m, &n.position_y_m,
                                      &n.yaw_rate_gain, &n.pitch_per_acceleration_radps2pm, &n.load_pitch_rad}) {
    *value = {0.5F, 0.25F};
  }
  n.azimuth_curve_step_rad = 0.25F;
  return n;
}

inline std::vector<std::string> alignments() {
  align::Result result;
  result.true_speed_scale = 1.0;
  result.speed_scale_support = "supported";
  align::RadarResult& radar = result.radars.emplace_back();
  radar.name = kName;
  radar.step_changes.resize(1);
  radar.before_change.emplace();
  radar.message.finding = AlignmentFinding::kRadarsSwapped;
  radar.message.finding_radar = 2;
  radar.message.nuisance = result.vehicle_nuisance = known_nuisance();
  result.load_changes.resize(1);
  result.speed_changes.resize(1);
  result.batch.emplace();
  radar.support = {"supported", "supported", "not supported"};
  radar.message.kpis.scans_to_95_percent.fill(7);
  radar.truth.emplace().mountings.resize(2);
  result.series.resize(2);
  for (align::Sample& sample : result.series) sample.radars.resize(1);
  align::Result batch = result;
  batch.x_is_iteration = true;
  return {align::to_json(result, {"1", "d.csv", "e.csv", "car", "config", "truth", {"r.pcap"}}),
          align::to_json(batch, {}), align::to_json(unknown_alignment(), {})};
}

inline std::vector<std::string> plates() {
  calibrate::PlateRun good;
  good.measurements.number_of_tilts = good.result.number_of_tilts = good.result.tilts_used = 1;
  good.seed.emplace();
  calibrate::PlateRun failed;
  failed.measurements.number_of_tilts = 1;
  failed.result.failure = alignment::plate::Failure::kNoMaximum;
  return {calibrate::to_json(good), calibrate::to_json(failed)};
}

inline std::vector<std::string> reflector_runs() {
  calibrate::ReflectorRun good;
  good.table.positions.resize(1);
  good.table.lines = {2};
  good.result.used = {true};
  good.result.residual_azimuth_rad = good.result.residual_elevation_rad = {0.001};
  calibrate::ReflectorRun failed = good;
  failed.config.has_elevation = false;
  failed.result.problem = failed.line.problem = alignment::reflectors::Problem::kTooFewAgree;
  return {calibrate::to_json(good), calibrate::to_json(failed)};
}

inline std::vector<std::string> sensor_healths() {
  diagnostics::SensorHealth sensor;
  sensor.radar_name(kName);
  sensor.trouble_codes("C1A02-87");
  diagnostics::SensorHealth unknown;
  unknown.speed_scale(std::nanf(""));
  unknown.yaw().error_rad(std::nanf(""));
  return {diagnostics_text::to_json(sensor), diagnostics_text::to_json(unknown)};
}

inline std::vector<std::string> system_healths() {
  diagnostics::SystemHealth system;
  system.vehicle_name(kName);
  system.services("tracker:silent");
  diagnostics::SystemHealth unknown;
  const float nothing = std::nanf("");
  unknown.pipeline().queueing_max_ms(nothing);
  unknown.pipeline().latency_p99_ms(nothing);
  unknown.latency_p50_ms(nothing);
  unknown.latency_max_ms(nothing);
  return {diagnostics_text::to_json(system), diagnostics_text::to_json(unknown)};
}

/// All floats of these samples, so that a value that is not known is seen everywhere.
template <typename... Arrays>
void fill_with_nothing(Arrays&... arrays) {
  (arrays.fill(std::nanf("")), ...);
}

inline std::vector<std::string> track_lists() {
  const float nothing = std::nanf("");
  perception::TrackList list;
  list.vehicle_name(kName);
  perception::Track track;
  track.age_s(nothing);
  track.time_since_update_s(nothing);
  track.existence_probability(nothing);
  track.mirror_probability(nothing);
  track.heading_rad(nothing);
  track.length_m(nothing);
  track.width_m(nothing);
  track.height_m(nothing);
  fill_with_nothing(track.position_vehicle_m(), track.velocity_over_ground_mps(), track.class_probability(),
                    track.covariance());
  list.tracks() = {perception::Track(), track};
  perception::RoadEdge edge;
  edge.age_s(nothing);
  edge.time_since_update_s(nothing);
  edge.existence_probability(nothing);
  edge.start_x_m(nothing);
  edge.end_x_m(nothing);
  edge.scatter_std_m(nothing);
  fill_with_nothing(edge.coefficients(), edge.covariance());
  list.road_edges() = {perception::RoadEdge(), edge};
  perception::PathObject object;
  object.age_s(nothing);
  object.existence_probability(nothing);
  object.collision_probability(nothing);
  object.time_to_collision_s(nothing);
  object.time_to_collision_std_s(nothing);
  object.required_deceleration_mps2(nothing);
  object.path_offset_m(nothing);
  object.path_offset_std_m(nothing);
  object.length_m(nothing);
  object.width_m(nothing);
  fill_with_nothing(object.position_vehicle_m(), object.velocity_over_ground_mps(), object.position_covariance_m2());
  list.path_objects() = {perception::PathObject(), object};
  return {diagnostics_text::to_json(list)};
}

inline std::vector<std::string> alignment_samples() {
  const float nothing = std::nanf("");
  diagnostics::AlignmentEstimate estimate;
  estimate.radar_name(kName);
  diagnostics::AlignmentEstimate unknown;
  unknown.finding_value(nothing);
  unknown.speed_scale(nothing);
  unknown.alignment_yaw_rad(nothing);
  unknown.vehicle_roll_rad(nothing);
  unknown.yaw_rate_bias_radps(nothing);
  unknown.load_change().size(nothing);
  unknown.drift().yaw_radps(nothing);
  unknown.nuisance().time_offset_s().value(nothing);
  unknown.kpis().nees(nothing);
  fill_with_nothing(unknown.covariance(), unknown.vehicle_covariance(), unknown.step_change().rotation_vehicle_rad(),
                    unknown.nuisance().azimuth_curve_rad(), unknown.kpis().seconds_to_95_percent(),
                    unknown.kpis().drift_per_minute());
  return {diagnostics_text::to_json(estimate), diagnostics_text::to_json(unknown)};
}

inline std::vector<std::string> service_statuses() {
  diagnostics::ServiceStatus status;
  status.vehicle_name(kName);
  diagnostics::FaultCount fault;
  fault.name("input lost");
  status.faults().push_back(fault);
  status.sources().emplace_back();
  diagnostics::ServiceStatus unknown;
  unknown.last_heartbeat_s(std::nanf(""));
  unknown.processing_max_us(std::nanf(""));
  return {diagnostics_text::to_json(status), diagnostics_text::to_json(unknown)};
}

inline std::vector<std::string> fault_records() {
  diagnostics::FaultRecord record;
  diagnostics::FaultRecord unknown;
  for (diagnostics::FreezeFrame* const frame : {&unknown.first(), &unknown.latest()}) {
    const float nothing = std::nanf("");
    frame->speed_mps(nothing);
    frame->rate_hz(nothing);
    frame->detections_per_scan(nothing);
    frame->lateral_displacement_m(nothing);
    frame->reference_range_m(nothing);
    frame->lost_coverage_ratio(nothing);
    frame->range_loss_ratio(nothing);
    frame->velocity_error_mps(nothing);
    frame->estimate().fill(nothing);
    frame->covariance().fill(nothing);
  }
  return {diagnostics_text::to_json(record), diagnostics_text::to_json(unknown)};
}

inline std::vector<std::string> presences() {
  const dds::Presence silent{"boresight/sensor_health", "front", "car", dds::Absence::kDeadline, 1'800'000'000};
  return {diagnostics_text::to_json(silent, 1), diagnostics_text::to_json({}, 2)};
}

inline std::vector<std::string> diagnostic_arrays() {
  diagnostic_msgs::msg::dds_::DiagnosticArray_ array;
  diagnostic_msgs::msg::dds_::DiagnosticStatus_ status;
  status.name_("boresight/radar/" + kName);
  diagnostic_msgs::msg::dds_::KeyValue_ value;
  value.key_("scans");
  value.value_("7");
  status.values_().push_back(value);
  array.status_().push_back(status);
  return {diagnostics_text::to_json(array)};
}

/// By section of the page.
inline std::map<std::string, std::vector<Value>> written() {
  const std::map<std::string, std::vector<std::string>> texts = {
      {"Run folder: run.json", run_summaries()},
      {"Run folder: health.jsonl", verdicts()},
      {"boresight monitor", snapshots()},
      {"boresight fit-evidence", fits()},
      {"boresight score", scores()},
      {"boresight align", alignments()},
      {"boresight calibrate plate", plates()},
      {"boresight calibrate reflectors", reflector_runs()},
      {"boresight diagnostics", sensor_healths()},
      {"boresight diagnostics: system", system_healths()},
      {"boresight diagnostics: stale", presences()},
      {"boresight diagnostics --array", diagnostic_arrays()},
      {"boresight diagnostics --tracks", track_lists()},
      {"boresight diagnostics --alignment", alignment_samples()},
      {"boresight diagnostics --services", service_statuses()},
      {"boresight dtc list", fault_records()},
  };
  std::map<std::string, std::vector<Value>> values;
  for (const auto& [section, each] : texts) {
    for (const std::string& text : each) values[section].push_back(Value::parse(text));
  }
  return values;
}

}  // namespace boresight::json::testing
