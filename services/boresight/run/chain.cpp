#include "services/boresight/run/chain.hpp"

#include <algorithm>
#include <utility>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/tracker/core/make_tracker.hpp"

namespace boresight::run {

namespace {

/// The cores take time 0 for "never". Recordings that begin earlier than this are shifted for them.
constexpr std::int64_t kEarliest_ns = 10'000'000'000;

}  // namespace

Chain::Chain(const VehicleConfig& vehicle, const Settings& settings, Listeners listeners, std::int64_t (*cpu_ns)())
    : vehicle_(vehicle),
      listeners_(std::move(listeners)),
      cpu_ns_(cpu_ns),
      estimator_(vehicle, settings.estimator),
      corrector_(vehicle, settings.corrector),
      ghosts_(ghosts::make_method(settings.ghosts)),
      tracker_(tracking::make_tracker(settings.tracker.tracker, vehicle, settings.tracker)),
      health_(vehicle, settings.health) {
  for (const RadarConfig& radar : vehicle.radars) {
    nominal_.push_back(geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0));
  }
  for (std::uint32_t id = 0; id < sources.size(); ++id) sources[id].source_id = id;
}

std::int64_t Chain::to_core(std::int64_t time_ns) {
  if (!has_shift_) {
    has_shift_ = true;
    shift_ns_ = time_ns < kEarliest_ns ? kEarliest_ns - time_ns : 0;
  }
  return time_ns + shift_ns_;
}

void Chain::note_measurement(std::int64_t time_ns) {
  if (!has_start_) {
    has_start_ = true;
    start_ns_ = latest_ns_ = time_ns;
    health_.start(to_core(arrival_ns_));
  }
  latest_ns_ = std::max(latest_ns_, time_ns);
}

HealthWatch::Report Chain::health_report() {
  return [this](const HealthResult& verdicts, std::int64_t core_ns) {
    if (!listeners_.health) return;
    HealthResult result = verdicts;
    result.at = {core_ns - shift_ns_, start_ns_};
    listeners_.health(result);
  };
}

void Chain::advance(std::int64_t arrival_ns) {
  arrival_ns_ = arrival_ns;
  const std::int64_t core_ns = to_core(arrival_ns);
  if (health_.is_started()) timed(times_.health, [&] { health_.advance(core_ns, sources, health_report()); });
}

void Chain::finish() {
  timed(times_.health, [&] { health_.finish(sources, health_report()); });
}

void Chain::add_ego(EgoMotion& motion, std::int64_t time_ns) {
  motion.header = {};
  motion.header.version = EgoMotion::kVersion;
  motion.header.sequence = motion.header.source_sequence = ++counts_.ego_motions;
  motion.header.measurement_time_ns = to_core(time_ns);
  motion.header.time_source = TimeSource::kLinkArrival;
  note_measurement(time_ns);
  timed(times_.estimator, [&] { estimator_.add_ego_motion(motion); });
  timed(times_.corrector, [&] { corrector_.add_ego_motion(motion); });
  timed(times_.health, [&] { health_.observe(motion); });
}

bool Chain::add_scan(RadarScan& scan, std::int64_t time_ns) {
  const std::uint32_t id = scan.header.source_id;
  if (!corrector_.knows(id)) {
    ++counts_.unknown_radar_scans;
    return false;
  }
  const std::uint64_t number = ++counts_.radars[id].scans;
  scan.header = {};
  scan.header.version = RadarScan::kVersion;
  scan.header.source_id = id;
  scan.header.sequence = ++scans_;
  scan.header.source_sequence = number;
  scan.header.measurement_time_ns = to_core(time_ns);
  scan.header.time_source = TimeSource::kLinkArrival;
  corrected_->header = classified_->header = tracks_->header = scan.header;
  corrected_->header.version = CorrectedScan::kVersion;
  classified_->header.version = ClassifiedScan::kVersion;
  tracks_->header.version = TrackList::kVersion;
  note_measurement(time_ns);

  timed(times_.health, [&] { health_.observe(scan); });
  timed(times_.corrector, [&] { corrector_.correct(scan, *corrected_); });
  timed(times_.ghost_filter, [&] { ghosts_->classify(*corrected_, *classified_); });
  timed(times_.tracker, [&] {
    const tracking::StepResult step = tracker_->step(*classified_);
    counts_.scans_out_of_order += step.out_of_order ? 1 : 0;
    counts_.tracker_restarts += step.restarted ? 1 : 0;
    counts_.tracker_at_budget += step.budget_reached ? 1 : 0;
    counts_.tracker_cut_gates += step.cut_gates > 0 ? 1 : 0;
    counts_.tracker_dropped_detections += step.dropped_detections;
    counts_.tracker_dropped_objects += step.dropped_objects;
    tracker_->write(*tracks_);
    counts_.tracker_dropped_objects += tracks_->dropped_tracks;
  });
  timed(times_.ghost_filter, [&] { ghosts_->add_tracks(*tracks_); });
  const ScanResult result{{time_ns, start_ns_}, number, scan, *classified_, *tracks_};
  add(result, counts_);
  if (listeners_.scan) listeners_.scan(result);
  publish_estimate(scan, time_ns);
  return true;
}

void Chain::publish_estimate(const RadarScan& scan, std::int64_t time_ns) {
  alignment::ScanResult verdict{};
  timed(times_.estimator, [&] { verdict = estimator_.add_scan(scan); });
  if (verdict != alignment::ScanResult::kPublish) return;
  const std::uint32_t id = scan.header.source_id;
  AlignmentEstimate message{};
  timed(times_.estimator, [&] { static_cast<void>(estimator_.write(id, message)); });
  message.header.version = AlignmentEstimate::kVersion;
  message.header.source_id = id;
  message.header.sequence = ++estimates_;
  message.header.source_sequence = ++counts_.radars[id].estimates;
  message.header.measurement_time_ns = scan.header.measurement_time_ns;
  message.header.time_source = scan.header.time_source;
  timed(times_.corrector, [&] { static_cast<void>(corrector_.add_alignment(message)); });
  timed(times_.health, [&] { health_.observe(message); });
  if (!listeners_.estimate) return;
  const auto index = static_cast<std::size_t>(vehicle_.radar(id) - vehicle_.radars.data());
  const alignment::RadarEstimate estimate = estimator_.estimate(index);
  const Eigen::Matrix3d turned = estimate.sensor_to_vehicle * nominal_[index].transpose();
  listeners_.estimate({{time_ns, start_ns_}, message, geometry::so3_log(turned), estimate.covariance});
}

}  // namespace boresight::run
