#include "services/health/core/pipeline_monitor.hpp"

#include <algorithm>

namespace boresight::health {

namespace {

std::uint64_t count_of(const ServiceStatus& status, Fault fault) {
  return status.faults[static_cast<std::size_t>(fault)];
}

/// Scans that the service did not hand on. A work budget loses none.
std::uint64_t lost_scans_of(const ServiceStatus& status) {
  return count_of(status, Fault::kInputLost) + count_of(status, Fault::kInputDropped) +
         count_of(status, Fault::kLoanFailed);
}

std::uint32_t growth(std::uint64_t now, std::uint64_t before) {
  return static_cast<std::uint32_t>(now > before ? now - before : 0);
}

/// None without scans to test.
TestResult share_test(std::uint64_t count, std::uint64_t total, double max_ratio) {
  if (total == 0) return TestResult::kNone;
  return static_cast<double>(count) > max_ratio * static_cast<double>(total) ? TestResult::kFailed
                                                                             : TestResult::kPassed;
}

}  // namespace

PipelineMonitor::PipelineMonitor(const Config& config, std::int64_t silence_ns, std::int64_t start_ns)
    : config_(config.pipeline),
      silence_ns_(silence_ns),
      grace_end_ns_(start_ns + static_cast<std::int64_t>(config.start_grace_s * 1e9)),
      window_(config.pipeline.window_s) {}

void PipelineMonitor::scan_arrived(std::int64_t now_ns) {
  if (last_scan_ns_ == kNever || now_ns - last_scan_ns_ > silence_ns_) flow_since_ns_ = now_ns;
  last_scan_ns_ = now_ns;
}

void PipelineMonitor::observe(const TrackList& tracks, std::int64_t now_ns) {
  last_tracks_ns_ = now_ns;
  const std::int64_t arrival_ns = tracks.header.stage(Stage::kIngest).begin_ns;
  const std::int64_t end_ns = tracks.header.stage(Stage::kTracker).end_ns;
  if (arrival_ns <= 0 || end_ns < arrival_ns) return;  // not stamped
  PipelineCounts& counts = window_.at(now_ns);
  counts.latencies.add(end_ns - arrival_ns);
  if (static_cast<double>(end_ns - arrival_ns) * 1e-9 > config_.latency_budget_s) ++counts.late;
}

void PipelineMonitor::observe(const ServiceStatus& status, std::int64_t now_ns) {
  const std::uint32_t index = status.header.source_id;
  if (index >= heartbeats_.size() || !catalogue::is_on_data_path(static_cast<catalogue::Service>(index))) return;
  Heartbeat& last = heartbeats_[index];
  if (status.incarnation_ns < last.incarnation_ns) return;  // a late heartbeat of a process that has ended
  const Heartbeat present{.incarnation_ns = status.incarnation_ns,
                          .received_ns = now_ns,
                          .outputs = status.outputs,
                          .lost = lost_scans_of(status),
                          .budget_hits = count_of(status, Fault::kWorkBudget),
                          .queueing_max_us = status.queueing_max_us};
  // Counters of a new process, or of one that ran before this one, have no earlier value.
  if (present.incarnation_ns == last.incarnation_ns) {
    PipelineCounts& counts = window_.at(now_ns);
    counts.lost += growth(present.lost, last.lost);
    counts.budget_hits += growth(present.budget_hits, last.budget_hits);
    counts.queueing_max_us = std::max(counts.queueing_max_us, present.queueing_max_us);
    if (static_cast<catalogue::Service>(index) == catalogue::Service::kTracker) {
      counts.delivered += growth(present.outputs, last.outputs);
    }
  }
  last = present;
}

TestResult PipelineMonitor::silence(std::int64_t now_ns) const {
  // By the latest scan, not by the present time: if the radars end, the track lists end with them.
  const bool has_tracks = last_tracks_ns_ != kNever;
  const bool is_unanswered =
      last_scan_ns_ != kNever && last_scan_ns_ - std::max(last_tracks_ns_, flow_since_ns_) > silence_ns_;
  if (is_unanswered) return has_tracks || now_ns > grace_end_ns_ ? TestResult::kFailed : TestResult::kNone;
  return has_tracks && now_ns - last_tracks_ns_ <= silence_ns_ ? TestResult::kPassed : TestResult::kNone;
}

bool PipelineMonitor::queues(std::int64_t now_ns) const {
  const auto window_ns = static_cast<std::int64_t>(config_.window_s * 1e9);
  return std::any_of(heartbeats_.begin(), heartbeats_.end(), [&](const Heartbeat& heartbeat) {
    return heartbeat.received_ns != kNever && now_ns - heartbeat.received_ns <= window_ns &&
           static_cast<double>(heartbeat.queueing_max_us) * 1e-6 > config_.queueing_budget_s;
  });
}

PipelineHealth PipelineMonitor::judge(FaultMemory& faults, std::int64_t now_ns, const FreezeFrame& frame) {
  const PipelineCounts counts = window_.sum(now_ns);
  const std::uint32_t scans = counts.delivered + counts.lost;
  const auto report = [&](PipelineEvent event, TestResult result) {
    faults.report({kind_of(event)}, result, now_ns, frame);
  };
  report(PipelineEvent::kLosing, share_test(counts.lost, scans, config_.max_lost_ratio));
  report(PipelineEvent::kQueueing, queues(now_ns) ? TestResult::kFailed
                                   : scans > 0    ? TestResult::kPassed
                                                  : TestResult::kNone);
  report(PipelineEvent::kWorkBudget, share_test(counts.budget_hits, counts.delivered, config_.max_work_budget_ratio));
  report(PipelineEvent::kLate, share_test(counts.late, counts.latencies.total(), config_.max_late_ratio));
  report(PipelineEvent::kSilent, silence(now_ns));

  PipelineHealth health{};
  health.data_qualifier = last_tracks_ns_ == kNever ? DataQualifier::kNotAvailable : DataQualifier::kAvailable;
  for (std::size_t i = 0; i < kNumberOfPipelineEvents; ++i) {
    const EventKind kind = kind_of(static_cast<PipelineEvent>(i));
    if (!faults.is_failed({kind})) continue;
    health.failed_events |= 1U << i;
    health.data_qualifier = std::max(health.data_qualifier, type_of(kind).effect);
  }
  constexpr double kMillisecondsPerMicrosecond = 1e-3;
  health.lost_scans = counts.lost;
  health.budget_hits = counts.budget_hits;
  health.queueing_max_ms = counts.queueing_max_us * static_cast<float>(kMillisecondsPerMicrosecond);
  health.latency_p99_ms = static_cast<float>(counts.latencies.percentile_us(0.99) * kMillisecondsPerMicrosecond);
  return health;
}

}  // namespace boresight::health
