// Health of the whole system: every radar, every service, and the way of the scans from reception to track list.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/service_status.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/estimation/latency_histogram.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/core/config.hpp"
#include "services/health/core/faults/fault_memory.hpp"
#include "services/health/core/pipeline_monitor.hpp"
#include "services/health/core/sensor_monitor.hpp"
#include "services/health/core/service_monitor.hpp"

namespace boresight::health {

/// Messages in, a report out. `now_ns` is CLOCK_MONOTONIC and does not go back. Data of radars that are not in the
/// vehicle file are ignored.
class Supervision {
 public:
  Supervision(const VehicleConfig& vehicle, const Config& config, std::int64_t start_ns);

  /// Values of each freeze frame: fingerprint of the configuration, version of the software.
  void set_origin(std::uint64_t configuration, std::string_view software);
  /// The fault memory, for restoring before restored(), for storing and for clearing.
  [[nodiscard]] FaultMemory& faults() { return faults_; }
  /// Continues with the verdicts that the fault memory was restored with. Call it before the first judgement.
  void restored();
  /// What the radars are used to deliver, to be kept over a restart, and what an earlier process kept.
  [[nodiscard]] VehicleLevels levels() const;
  void restore(const VehicleLevels& levels);

  void observe(const RadarScan& scan, std::int64_t now_ns);
  void observe(const EgoMotion& motion);
  void observe(const AlignmentEstimate& estimate);
  void observe(const TrackList& tracks, std::int64_t now_ns);
  void observe(const ServiceStatus& status, std::int64_t now_ns);

  /// Writes everything but the header. `epoch_ns` is the time since the epoch, for freeze frames.
  void judge(HealthReport& out, std::int64_t now_ns, std::int64_t epoch_ns);

 private:
  [[nodiscard]] SensorMonitor* sensor(std::uint32_t radar_id);

  Config config_;
  void report_change(EventKind kind, const AlignmentVehicleChange& change, std::int64_t now_ns);

  FaultMemory faults_;
  FreezeFrame vehicle_frame_;  // of the present time, without a radar's values
  std::vector<SensorMonitor> sensors_;
  std::vector<ServiceMonitor> services_;
  PipelineMonitor pipeline_;
  AlignmentVehicleChange load_change_{};   // the latest that an estimate reported
  AlignmentVehicleChange speed_change_{};  //
  LatencyHistogram latencies_;             // of the current window
  LatencyHistogram complete_latencies_;    // of the previous window
  std::int64_t window_begin_ns_;
};

/// True if the two reports differ in a verdict, not only in a number.
[[nodiscard]] bool verdicts_differ(const HealthReport& a, const HealthReport& b);

}  // namespace boresight::health
