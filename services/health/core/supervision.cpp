#include "services/health/core/supervision.hpp"

#include <algorithm>
#include <limits>

#include "interfaces/catalogue/catalogue.hpp"

namespace boresight::health {

namespace {

using catalogue::Service;
using catalogue::TopicId;

std::int64_t output_deadline_ns(Service service) {
  switch (service) {
    case Service::kAlignmentEstimator:
      return catalogue::topic(TopicId::kAlignmentEstimate).deadline_ns;
    case Service::kDetectionCorrector:
      return catalogue::topic(TopicId::kCorrectedScan).deadline_ns;
    case Service::kGhostFilter:
      return catalogue::topic(TopicId::kClassifiedScan).deadline_ns;
    case Service::kTracker:
      return catalogue::topic(TopicId::kTrackList).deadline_ns;
    default:
      return 0;  // gateway: the deadlines of the radars cover its input; health: this service
  }
}

/// Longest time without a track list while scans arrive: the topic's deadline, but no radar must be that slow.
std::int64_t silence_ns_of(const VehicleConfig& vehicle) {
  std::int64_t shortest_ns = std::numeric_limits<std::int64_t>::max();
  for (const RadarConfig& radar : vehicle.radars) {
    shortest_ns = std::min(shortest_ns, static_cast<std::int64_t>(radar.deadline_s * 1e9));
  }
  const std::int64_t deadline_ns = catalogue::topic(TopicId::kTrackList).deadline_ns;
  return vehicle.radars.empty() ? deadline_ns : std::max(deadline_ns, shortest_ns);
}

DataQualifier overall_of(const HealthReport& report) {
  const auto sensors_end = report.sensors.begin() + report.number_of_sensors;
  const auto services_end = report.services.begin() + report.number_of_services;
  const auto is = [](DataQualifier wanted) {
    return [wanted](const SensorHealth& sensor) { return sensor.data_qualifier == wanted; };
  };
  // The corrector continues without the estimator. Without any other stage no track list is published.
  const bool chain_is_broken = std::any_of(report.services.begin(), services_end, [](const ServiceHealth& s) {
    const bool carries_data = s.service != static_cast<std::uint32_t>(Service::kAlignmentEstimator) &&
                              s.service != static_cast<std::uint32_t>(Service::kHealth);
    return carries_data && (s.condition == ServiceCondition::kSilent || s.condition == ServiceCondition::kUnknown);
  });
  const DataQualifier pipeline = report.pipeline.data_qualifier;
  if (chain_is_broken || pipeline == DataQualifier::kNotAvailable ||
      std::all_of(report.sensors.begin(), sensors_end, is(DataQualifier::kNotAvailable))) {
    return DataQualifier::kNotAvailable;
  }
  const bool all_well = pipeline == DataQualifier::kAvailable &&
                        std::all_of(report.sensors.begin(), sensors_end, is(DataQualifier::kAvailable)) &&
                        std::all_of(report.services.begin(), services_end,
                                    [](const ServiceHealth& s) { return s.condition == ServiceCondition::kAlive; });
  return all_well ? DataQualifier::kAvailable : DataQualifier::kAvailableReduced;
}

}  // namespace

Supervision::Supervision(const VehicleConfig& vehicle, const Config& config, std::int64_t start_ns)
    : config_(config),
      faults_(vehicle, config.faults),
      pipeline_(config, silence_ns_of(vehicle), start_ns),
      window_begin_ns_(start_ns) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  vehicle_frame_.speed_mps = vehicle_frame_.rate_hz = vehicle_frame_.detections_per_scan = kUnknown;
  vehicle_frame_.lateral_displacement_m = vehicle_frame_.reference_range_m = kUnknown;
  vehicle_frame_.estimate.fill(kUnknown);
  vehicle_frame_.covariance.fill(kUnknown);
  for (const RadarConfig& radar : vehicle.radars) {
    if (sensors_.size() < kMaxRadars) sensors_.emplace_back(radar, config, start_ns);
  }
  const std::int64_t heartbeat_deadline_ns = catalogue::topic(TopicId::kServiceStatus).deadline_ns;
  for (std::uint32_t i = 0; i < catalogue::kNumberOfSupervisedServices; ++i) {
    services_.emplace_back(i, heartbeat_deadline_ns, output_deadline_ns(static_cast<Service>(i)), config, start_ns);
  }
}

void Supervision::set_origin(std::uint64_t configuration, std::string_view software) {
  vehicle_frame_.configuration = configuration;
  vehicle_frame_.software = {};
  std::copy_n(software.begin(), std::min(software.size(), vehicle_frame_.software.size() - 1),
              vehicle_frame_.software.begin());
}

void Supervision::restored() {
  for (SensorMonitor& sensor : sensors_) sensor.restore(faults_);
}

VehicleLevels Supervision::levels() const {
  VehicleLevels levels;
  for (const SensorMonitor& sensor : sensors_) levels.radars[levels.number_of_radars++] = sensor.levels();
  return levels;
}

void Supervision::restore(const VehicleLevels& levels) {
  for (std::size_t i = 0; i < levels.number_of_radars; ++i) {
    if (SensorMonitor* const s = sensor(levels.radars[i].radar_id)) s->restore(levels.radars[i]);
  }
}

SensorMonitor* Supervision::sensor(std::uint32_t radar_id) {
  const auto found = std::find_if(sensors_.begin(), sensors_.end(),
                                  [radar_id](const SensorMonitor& s) { return s.radar_id() == radar_id; });
  return found == sensors_.end() ? nullptr : &*found;
}

void Supervision::observe(const RadarScan& scan, std::int64_t now_ns) {
  SensorMonitor* const s = sensor(scan.header.source_id);
  if (s == nullptr) return;
  s->observe(scan, now_ns);
  pipeline_.scan_arrived(now_ns);
}

void Supervision::observe(const EgoMotion& motion) {
  vehicle_frame_.speed_mps = motion.has(ego_field::kSpeed) ? motion.speed_mps : std::numeric_limits<float>::quiet_NaN();
  for (SensorMonitor& sensor : sensors_) sensor.observe(motion);
}

void Supervision::observe(const AlignmentEstimate& estimate) {
  SensorMonitor* const s = sensor(estimate.header.source_id);
  if (s == nullptr) return;
  s->observe(estimate);
  // The estimates of all radars report the same event.
  if (estimate.load_change.time_ns > load_change_.time_ns) load_change_ = estimate.load_change;
  if (estimate.speed_change.time_ns > speed_change_.time_ns) speed_change_ = estimate.speed_change;
}

void Supervision::observe(const TrackList& tracks, std::int64_t now_ns) {
  pipeline_.observe(tracks, now_ns);
  if (static_cast<double>(now_ns - window_begin_ns_) * 1e-9 > config_.window_s) {
    complete_latencies_ = latencies_;
    latencies_ = {};
    window_begin_ns_ = now_ns;
  }
  const std::int64_t begin_ns = tracks.header.stage(Stage::kIngest).begin_ns;
  const std::int64_t end_ns = tracks.header.stage(Stage::kTracker).end_ns;
  if (begin_ns > 0 && end_ns >= begin_ns) latencies_.add(end_ns - begin_ns);
}

void Supervision::observe(const ServiceStatus& status, std::int64_t now_ns) {
  const std::uint32_t index = status.header.source_id;
  if (index >= services_.size()) return;
  services_[index].observe(status, now_ns);
  pipeline_.observe(status, now_ns);
  if (static_cast<Service>(index) != Service::kIngestGateway) return;
  for (const SourceStatistics& source : status.sources) {
    if (SensorMonitor* const s = sensor(source.source_id)) s->observe(source, now_ns);
  }
}

void Supervision::report_change(EventKind kind, const AlignmentVehicleChange& change, std::int64_t now_ns) {
  if (change.time_ns == 0) return;
  // A restarted estimator or health service hears of the same change again.
  const Event event{kind};
  const FaultRecord* const known = faults_.find(event);
  const bool is_known = known != nullptr && known->status.occurrences > 0 && known->latest.cycle == faults_.cycle() &&
                        change.time_ns <= static_cast<std::int64_t>(known->latest.uptime_ns);
  if (!is_known) faults_.report_once(event, now_ns, vehicle_frame_);
}

void Supervision::judge(HealthReport& out, std::int64_t now_ns, std::int64_t epoch_ns) {
  vehicle_frame_.time_ns = epoch_ns;
  vehicle_frame_.uptime_ns = static_cast<std::uint64_t>(now_ns);
  vehicle_frame_.cycle = faults_.cycle();
  report_change(EventKind::kLoadChange, load_change_, now_ns);
  report_change(EventKind::kSpeedSignalChange, speed_change_, now_ns);
  out.reserved = {};
  out.load_change = load_change_;
  out.speed_change = speed_change_;
  out.sensors = {};
  out.services = {};
  out.number_of_sensors = static_cast<std::uint32_t>(sensors_.size());
  out.number_of_services = static_cast<std::uint32_t>(services_.size());
  bool scans_flow = false;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    out.sensors[i] = sensors_[i].judge(faults_, now_ns, vehicle_frame_);
    scans_flow = scans_flow || sensors_[i].delivers(now_ns);
  }
  // A stage is late only if the stage before it delivers: a broken chain is reported at its first broken stage.
  const auto delivers = [&](Service s) { return services_[static_cast<std::size_t>(s)].delivers(now_ns); };
  for (std::size_t i = 0; i < services_.size(); ++i) {
    const auto service = static_cast<Service>(i);
    bool input_flows = scans_flow;
    if (service == Service::kGhostFilter) input_flows = delivers(Service::kDetectionCorrector);
    if (service == Service::kTracker) input_flows = delivers(Service::kGhostFilter);
    out.services[i] = services_[i].judge(input_flows, now_ns);
    services_[i].report(out.services[i], faults_, now_ns, vehicle_frame_);
  }
  out.pipeline = pipeline_.judge(faults_, now_ns, vehicle_frame_);
  const LatencyHistogram& latencies = complete_latencies_.total() > 0 ? complete_latencies_ : latencies_;
  out.latency_p50_ms = static_cast<float>(latencies.percentile_us(0.5) * 1e-3);
  out.latency_max_ms = static_cast<float>(latencies.max_us() * 1e-3);
  out.stored_events = faults_.stored();
  out.overall = overall_of(out);
}

bool verdicts_differ(const HealthReport& a, const HealthReport& b) {
  if (a.overall != b.overall || a.number_of_sensors != b.number_of_sensors) return true;
  if (a.pipeline.data_qualifier != b.pipeline.data_qualifier) return true;
  if (a.pipeline.failed_events != b.pipeline.failed_events) return true;
  if (a.load_change.time_ns != b.load_change.time_ns || a.speed_change.time_ns != b.speed_change.time_ns) return true;
  for (std::size_t i = 0; i < a.number_of_sensors; ++i) {
    const SensorHealth &x = a.sensors[i], &y = b.sensors[i];
    if (x.data_qualifier != y.data_qualifier || x.extended_qualifier != y.extended_qualifier) return true;
    if (x.finding != y.finding || (x.drift.since_ns != 0) != (y.drift.since_ns != 0)) return true;
    if (x.conditions != y.conditions || x.failed_events != y.failed_events) return true;
  }
  for (std::size_t i = 0; i < a.number_of_services && i < kMaxServices; ++i) {
    const ServiceHealth &x = a.services[i], &y = b.services[i];
    if (x.condition != y.condition || x.deadline_missed != y.deadline_missed) return true;
  }
  return false;
}

}  // namespace boresight::health
