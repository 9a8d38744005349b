#include "services/boresight/run/health_watch.hpp"

#include <algorithm>
#include <limits>

#include "interfaces/catalogue/catalogue.hpp"

namespace boresight::run {

namespace {

constexpr std::int64_t kJudgePeriod_ns = 20'000'000;  // of the health service
constexpr std::int64_t kReportPeriod_ns = 1'000'000'000;
constexpr std::int64_t kLongestPause_ns = 10'000'000'000;  // longer than any deadline: nothing changes after it
constexpr std::int64_t kClockReset_ns = 1'000'000'000;     // as the gateway judges its recordings

DataQualifier overall_of(const HealthResult& verdicts) {
  const auto end = verdicts.sensors.begin() + static_cast<std::ptrdiff_t>(verdicts.number_of_sensors);
  const auto is = [](DataQualifier wanted) {
    return [wanted](const SensorHealth& sensor) { return sensor.data_qualifier == wanted; };
  };
  if (std::all_of(verdicts.sensors.begin(), end, is(DataQualifier::kNotAvailable))) return DataQualifier::kNotAvailable;
  const bool all_well = std::all_of(verdicts.sensors.begin(), end, is(DataQualifier::kAvailable));
  return all_well ? DataQualifier::kAvailable : DataQualifier::kAvailableReduced;
}

bool differ(const HealthResult& a, const HealthResult& b) {
  if (a.load_change.time_ns != b.load_change.time_ns || a.speed_change.time_ns != b.speed_change.time_ns) return true;
  for (std::size_t i = 0; i < a.number_of_sensors; ++i) {
    const SensorHealth &x = a.sensors[i], &y = b.sensors[i];
    if (x.data_qualifier != y.data_qualifier || x.extended_qualifier != y.extended_qualifier ||
        x.conditions != y.conditions || x.finding != y.finding || (x.drift.since_ns != 0) != (y.drift.since_ns != 0)) {
      return true;
    }
  }
  return false;
}

}  // namespace

void HealthWatch::start(std::int64_t now_ns) {
  faults_.emplace(vehicle_, config_.faults);
  for (const RadarConfig& radar : vehicle_.radars) {
    if (sensors_.size() < kMaxRadars) sensors_.emplace_back(radar, config_, now_ns);
  }
  own_ns_ = next_judgement_ns_ = next_report_ns_ = next_heartbeat_ns_ = now_ns;
}

health::SensorMonitor* HealthWatch::sensor(std::uint32_t radar_id) {
  const auto found = std::find_if(sensors_.begin(), sensors_.end(),
                                  [radar_id](const health::SensorMonitor& s) { return s.radar_id() == radar_id; });
  return found == sensors_.end() ? nullptr : &*found;
}

void HealthWatch::observe(const RadarScan& scan) {
  if (health::SensorMonitor* const s = sensor(scan.header.source_id)) s->observe(scan, own_ns_);
}

void HealthWatch::observe(const AlignmentEstimate& estimate) {
  health::SensorMonitor* const s = sensor(estimate.header.source_id);
  if (s == nullptr) return;
  s->observe(estimate);
  if (estimate.load_change.time_ns > load_change_.time_ns) load_change_ = estimate.load_change;
  if (estimate.speed_change.time_ns > speed_change_.time_ns) speed_change_ = estimate.speed_change;
}

void HealthWatch::observe(const EgoMotion& motion) {
  vehicle_frame_.speed_mps = motion.has(ego_field::kSpeed) ? motion.speed_mps : std::numeric_limits<float>::quiet_NaN();
  for (health::SensorMonitor& sensor : sensors_) sensor.observe(motion);
}

void HealthWatch::take(std::span<const SourceStatistics> sources, std::int64_t own_ns) {
  for (const SourceStatistics& source : sources) {
    if (health::SensorMonitor* const s = sensor(source.source_id)) s->observe(source, own_ns);
  }
}

void HealthWatch::judge(std::int64_t own_ns, bool always, const Report& report) {
  HealthResult verdicts;
  verdicts.number_of_sensors = sensors_.size();
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    verdicts.sensors[i] = sensors_[i].judge(*faults_, own_ns, vehicle_frame_);
  verdicts.overall = overall_of(verdicts);
  verdicts.load_change = load_change_;
  verdicts.speed_change = speed_change_;
  if (has_reported_ && !always && own_ns < next_report_ns_ && !differ(verdicts, reported_)) return;
  if (own_ns >= next_report_ns_) next_report_ns_ = own_ns + kReportPeriod_ns;
  reported_ = verdicts;
  has_reported_ = true;
  reported_ns_ = own_ns;
  report(verdicts, own_ns - offset_ns_);
}

void HealthWatch::advance(std::int64_t now_ns, std::span<const SourceStatistics> sources, const Report& report) {
  if (!is_started()) return;
  if (now_ns + offset_ns_ < own_ns_ - kClockReset_ns) offset_ns_ = own_ns_ - now_ns;
  const std::int64_t last_input_ns = own_ns_;
  own_ns_ = std::max(own_ns_, now_ns + offset_ns_);
  while (next_judgement_ns_ <= own_ns_) {
    if (next_judgement_ns_ >= next_heartbeat_ns_) {
      take(sources, next_judgement_ns_);
      next_heartbeat_ns_ = next_judgement_ns_ + catalogue::topic(catalogue::TopicId::kServiceStatus).period_ns;
    }
    judge(next_judgement_ns_, false, report);
    next_judgement_ns_ += kJudgePeriod_ns;
    if (next_judgement_ns_ > last_input_ns + kLongestPause_ns) {
      next_judgement_ns_ = std::max(next_judgement_ns_, own_ns_);
    }
  }
}

void HealthWatch::finish(std::span<const SourceStatistics> sources, const Report& report) {
  if (!is_started()) return;
  if (reported_ns_ == own_ns_) return;
  take(sources, own_ns_);
  judge(own_ns_, true, report);
}

}  // namespace boresight::run
