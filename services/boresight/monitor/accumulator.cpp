#include "services/boresight/monitor/accumulator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interfaces/messages/corrected_scan.hpp"
#include "services/common/alignment_words/alignment_words.hpp"

namespace boresight::monitor {

namespace {

constexpr std::int64_t kRateWindow_ns = 2'000'000'000;

double std_of(const std::array<float, 16>& covariance, AlignmentParameter parameter) {
  const auto i = static_cast<std::size_t>(parameter);
  return std::sqrt(std::max(0.0F, covariance[i * kNumberOfAlignmentParameters + i]));
}

AlignmentDetails details_of(const AlignmentEstimate& e) {
  AlignmentDetails d;
  d.yaw = {e.vehicle_yaw_rad, std_of(e.vehicle_covariance, AlignmentParameter::kYaw),
           e.is_observable(alignment_axis::kVehicleYaw)};
  d.pitch = {e.vehicle_pitch_rad, std_of(e.vehicle_covariance, AlignmentParameter::kPitch),
             e.is_observable(alignment_axis::kVehiclePitch)};
  d.roll = {e.vehicle_roll_rad, std_of(e.vehicle_covariance, AlignmentParameter::kRoll),
            e.is_observable(alignment_axis::kVehicleRoll)};
  d.yaw_rate_bias = {e.yaw_rate_bias_radps, e.yaw_rate_bias_std_radps, e.is_observable(alignment_axis::kYawRateBias)};
  d.slip = {e.slip_coefficient_radps2pm, e.slip_coefficient_std_radps2pm, e.is_observable(alignment_axis::kSlip)};
  d.step_changes = e.step_change.count;
  d.reason = alignment_words::key_of(e.reason);
  d.finding = alignment_words::key_of(e.finding);
  d.range_rate_scale = e.nuisance.range_rate_scale.value;
  d.range_rate_scale_std = e.nuisance.range_rate_scale.std;
  d.drift = alignment_words::drift_sentence(e.drift);
  d.yaw_seconds_to_95_percent = e.kpis.seconds_to_95_percent[static_cast<std::size_t>(AlignmentParameter::kYaw)];
  d.pitch_seconds_to_95_percent = e.kpis.seconds_to_95_percent[static_cast<std::size_t>(AlignmentParameter::kPitch)];
  d.yaw_drift_radpmin = e.kpis.drift_per_minute[static_cast<std::size_t>(AlignmentParameter::kYaw)];
  d.residual_rmse_mps = e.kpis.residual_rmse_mps;
  d.nees = e.kpis.nees;
  return d;
}

}  // namespace

Accumulator::Accumulator(const VehicleConfig& vehicle) : vehicle_(vehicle) {
  for (const RadarConfig& config : vehicle.radars) {
    RadarMemory memory;
    memory.seen.id = config.id;
    memory.seen.name = config.name;
    memory.seen.yaw_tolerance_rad = config.tolerance.yaw_rad;
    radars_.push_back(std::move(memory));
  }
  for (std::size_t i = 0; i < catalogue::kNumberOfSupervisedServices; ++i) {
    ServiceSnapshot service;
    service.service = static_cast<catalogue::Service>(i);
    current_.services.push_back(service);
  }
}

Accumulator::RadarMemory& Accumulator::radar(std::uint32_t id) {
  for (RadarMemory& memory : radars_) {
    if (memory.seen.id == id) return memory;
  }
  RadarMemory memory;
  memory.seen.id = id;
  memory.seen.name = "radar_" + std::to_string(id);
  radars_.push_back(std::move(memory));
  return radars_.back();
}

ServiceSnapshot& Accumulator::service(std::uint32_t index) {
  return current_.services[std::min<std::size_t>(index, current_.services.size() - 1)];
}

void Accumulator::observe(const RadarScan& scan, std::int64_t now_ns) {
  RadarMemory& memory = radar(scan.header.source_id);
  const std::uint64_t sequence = scan.header.source_sequence;
  if (memory.last_sequence != 0 && sequence > memory.last_sequence) {
    memory.seen.lost += sequence - memory.last_sequence - 1;
  }
  memory.last_sequence = sequence;
  ++memory.seen.scans;
  memory.seen.detections = scan.number_of_valid_detections;
  memory.arrivals_ns.push_back(now_ns);
  while (memory.arrivals_ns.front() < now_ns - kRateWindow_ns) memory.arrivals_ns.pop_front();
}

void Accumulator::observe(const EgoMotion& ego) {
  if (ego.has(ego_field::kSpeed)) current_.ego_speed_mps = ego.speed_mps;
  if (ego.has(ego_field::kYawRate)) current_.ego_yaw_rate_radps = ego.yaw_rate_radps;
}

void Accumulator::observe(const AlignmentEstimate& estimate) {
  RadarSnapshot& seen = radar(estimate.header.source_id).seen;
  seen.state = estimate.state;
  seen.yaw = {estimate.alignment_yaw_rad, std_of(estimate.covariance, AlignmentParameter::kYaw),
              estimate.is_observable(alignment_axis::kYaw)};
  seen.pitch = {estimate.alignment_pitch_rad, std_of(estimate.covariance, AlignmentParameter::kPitch),
                estimate.is_observable(alignment_axis::kPitch)};
  seen.roll = {estimate.alignment_roll_rad, std_of(estimate.covariance, AlignmentParameter::kRoll),
               estimate.is_observable(alignment_axis::kRoll)};
  seen.speed_scale = estimate.speed_scale;
  seen.speed_scale_std = std_of(estimate.covariance, AlignmentParameter::kSpeedScale);
  seen.details = details_of(estimate);
}

void Accumulator::observe(const ClassifiedScan& scan) {
  RadarSnapshot& seen = radar(scan.header.source_id).seen;
  seen.moving = 0;
  seen.ghosts = 0;
  ++seen.labels.scans;
  if ((scan.flags & (pipeline_flag::kNoTracks | pipeline_flag::kTracksStale)) != 0) ++seen.labels.scans_without_tracks;
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    if (scan.provenance[i] == Provenance::kMoving) ++seen.moving;
    if (scan.provenance[i] == Provenance::kGhostType1 || scan.provenance[i] == Provenance::kGhostType2) ++seen.ghosts;
    const auto label = static_cast<std::size_t>(scan.provenance[i]);
    if ((scan.detection_flags[i] & corrected_flag::kRejected) != 0) {
      ++seen.labels.rejected;
    } else {
      ++seen.labels.classified[label < seen.labels.classified.size() ? label : 0];
    }
  }
}

void Accumulator::observe(const TrackList& list) {
  ++current_.track_lists;
  current_.tracks.clear();
  const std::size_t count = std::min<std::size_t>(list.number_of_tracks, kMaxTracks);
  for (std::size_t i = 0; i < count; ++i) {
    const Track& track = list.tracks[i];
    current_.tracks.push_back({.id = track.tracking_id,
                               .confirmed = track.status == TrackStatus::kConfirmed,
                               .movement = track.movement,
                               .object_class = track.object_class,
                               .existence = track.existence_probability,
                               .mirror_probability = track.mirror_probability,
                               .x_m = track.position_vehicle_m[0],
                               .y_m = track.position_vehicle_m[1],
                               .vx_mps = track.velocity_over_ground_mps[0],
                               .vy_mps = track.velocity_over_ground_mps[1],
                               .age_s = track.age_s});
  }
  std::sort(current_.tracks.begin(), current_.tracks.end(), [](const TrackSnapshot& a, const TrackSnapshot& b) {
    return std::hypot(a.x_m, a.y_m) < std::hypot(b.x_m, b.y_m);
  });
  const auto& stages = list.header.stages;
  for (std::size_t i = 0; i < kNumberOfStages; ++i) {
    if (stages[i].begin_ns > 0 && stages[i].end_ns >= stages[i].begin_ns) {
      current_.latencies[i].add(stages[i].end_ns - stages[i].begin_ns);
    }
  }
  if (stages.front().begin_ns > 0 && stages.back().end_ns >= stages.front().begin_ns) {
    current_.latencies[kNumberOfStages].add(stages.back().end_ns - stages.front().begin_ns);
  }
}

void Accumulator::explain(std::uint32_t radar_id, std::string explanation,
                          const std::array<bool, 3>& beyond_tolerance) {
  RadarSnapshot& seen = radar(radar_id).seen;
  seen.explanation = std::move(explanation);
  seen.beyond_tolerance = beyond_tolerance;
}

void Accumulator::observe(const HealthReport& report) {
  current_.overall = report.overall;
  current_.pipeline = {.data_qualifier = report.pipeline.data_qualifier,
                       .failed_events = report.pipeline.failed_events,
                       .lost_scans = report.pipeline.lost_scans,
                       .budget_hits = report.pipeline.budget_hits,
                       .queueing_max_ms = report.pipeline.queueing_max_ms,
                       .latency_p99_ms = report.pipeline.latency_p99_ms};
  current_.load_change = alignment_words::load_change_sentence(report.load_change);
  current_.speed_change = alignment_words::speed_change_sentence(report.speed_change);
  for (std::size_t i = 0; i < std::min<std::size_t>(report.number_of_sensors, kMaxRadars); ++i) {
    const SensorHealth& health = report.sensors[i];
    if (health.radar_id == 0) continue;
    RadarSnapshot& seen = radar(health.radar_id).seen;
    seen.data_qualifier = health.data_qualifier;
    seen.extended_qualifier = health.extended_qualifier;
    explain(health.radar_id, alignment_words::explanation_of(health, vehicle_),
            {health.yaw.beyond_tolerance != 0, health.pitch.beyond_tolerance != 0, health.roll.beyond_tolerance != 0});
    seen.conditions = health.conditions;
    seen.missed = health.missed_scans;
    seen.suspect = health.suspect_scans;
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(report.number_of_services, kMaxServices); ++i) {
    const ServiceHealth& health = report.services[i];
    if (health.service >= current_.services.size()) continue;
    service(health.service).condition = health.condition;
    service(health.service).restarts = health.restarts;
    service(health.service).latency_mean_us = health.latency_mean_us;
  }
}

void Accumulator::observe(const ServiceStatus& status) {
  if (status.header.source_id >= current_.services.size()) return;
  ServiceSnapshot& seen = service(status.header.source_id);
  seen.inputs = status.inputs;
  seen.outputs = status.outputs;
  seen.heap_allocations = status.heap_allocations;
  seen.processing_max_us = std::max<double>(seen.processing_max_us, status.processing_max_us);
  seen.latency_max_us = std::max<double>(seen.latency_max_us, status.latency_max_us);
  seen.faults = status.faults;
}

Snapshot Accumulator::snapshot(std::int64_t now_ns) const {
  Snapshot result = current_;
  result.time_ns = now_ns;
  for (const RadarMemory& memory : radars_) {
    result.radars.push_back(memory.seen);
    const auto recent = std::count_if(memory.arrivals_ns.begin(), memory.arrivals_ns.end(),
                                      [now_ns](std::int64_t t) { return t >= now_ns - kRateWindow_ns; });
    result.radars.back().rate_hz = static_cast<double>(recent) / (static_cast<double>(kRateWindow_ns) * 1e-9);
  }
  return result;
}

}  // namespace boresight::monitor
