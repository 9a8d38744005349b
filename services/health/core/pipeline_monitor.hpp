// Verdict on the way of the scans from arrival to track list: losses, queueing, work budgets, lateness, silence.
#pragma once

#include <array>
#include <cstdint>

#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/service_status.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/health/core/config.hpp"
#include "services/health/core/faults/fault_memory.hpp"
#include "services/health/core/pipeline_window.hpp"

namespace boresight::health {

/// Uses heartbeats of the data path, track lists and the arrival of scans. Does not allocate. Times are
/// CLOCK_MONOTONIC, ns. A restart of a service is no loss, and silent radars are no failure.
class PipelineMonitor {
 public:
  /// `silence_ns`: longest time without a track list while scans arrive.
  PipelineMonitor(const Config& config, std::int64_t silence_ns, std::int64_t start_ns);

  /// A radar scan arrived from the gateway.
  void scan_arrived(std::int64_t now_ns);
  void observe(const TrackList& tracks, std::int64_t now_ns);
  /// Heartbeats of other services than those of the data path are ignored.
  void observe(const ServiceStatus& status, std::int64_t now_ns);

  /// Reports the result of each test to the fault memory. The verdict follows from the last known results; it is
  /// NOT_AVAILABLE before a first track list arrived.
  [[nodiscard]] PipelineHealth judge(FaultMemory& faults, std::int64_t now_ns, const FreezeFrame& frame);

 private:
  static constexpr std::int64_t kNever = -1;

  /// The latest heartbeat of a service.
  struct Heartbeat {
    std::int64_t incarnation_ns = kNever;
    std::int64_t received_ns = kNever;
    std::uint64_t outputs = 0;
    std::uint64_t lost = 0;
    std::uint64_t budget_hits = 0;
    float queueing_max_us = 0.0F;
  };

  [[nodiscard]] TestResult silence(std::int64_t now_ns) const;
  [[nodiscard]] bool queues(std::int64_t now_ns) const;

  PipelineConfig config_;
  std::int64_t silence_ns_;
  std::int64_t grace_end_ns_;
  PipelineWindow window_;
  std::array<Heartbeat, catalogue::kNumberOfSupervisedServices> heartbeats_{};
  std::int64_t last_scan_ns_ = kNever;
  std::int64_t flow_since_ns_ = kNever;  ///< the first scan after a pause of all radars
  std::int64_t last_tracks_ns_ = kNever;
};

}  // namespace boresight::health
