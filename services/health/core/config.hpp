// Settings of the health service; the defaults are what config/services/health.toml ships.
#pragma once

#include "services/health/core/faults/fault_memory.hpp"
#include "services/health/core/function/delivery_monitor.hpp"
#include "services/health/core/function/disturbance_monitor.hpp"
#include "services/health/core/function/sight_monitor.hpp"

namespace boresight::health {

/// Tests of the way of the scans from arrival to track list.
struct PipelineConfig {
  double window_s = 0.3;               ///< time window of the figures (choice: verdict within 0.5 s)
  double latency_budget_s = 0.05;      ///< from arrival to track list (choice: one cycle; measured p99: 4 ms)
  double max_late_ratio = 0.1;         ///< of the track lists, beyond the latency budget (choice)
  double queueing_budget_s = 0.025;    ///< that a scan may wait for a stage (choice: half a cycle)
  double max_lost_ratio = 0.07;        ///< of the scans, lost or dropped between the stages (choice)
  double max_work_budget_ratio = 0.2;  ///< of the scans, at a work budget (choice)
};

struct Config {
  double window_s = 2.0;            ///< time window of rates, losses and latencies
  double max_rejected_ratio = 0.2;  ///< a larger share of rejected frames is INVALID_DATA
  double max_suspect_ratio = 0.1;   ///< a larger share of scans of doubtful integrity is INVALID_DATA
  double restart_memory_s = 3.0;    ///< time for which a service counts as restarted
  double start_grace_s = 5.0;       ///< time for the services to start, before one without a heartbeat is silent
  // Misalignment: an axis is beyond its tolerance or limit if that is probable enough.
  double confidence = 0.99;          ///< least probability of a verdict
  double set_s = 3.0;                ///< time for which an axis must be beyond its tolerance to be reported
  double clear_s = 5.0;              ///< time for which it must be within to withdraw the report
  double clear_ratio = 0.9;          ///< withdrawn: below this share of the tolerance or limit
  double reference_range_m = 100.0;  ///< range at which the lateral displacement is stated
  PipelineConfig pipeline = {};
  DeliveryConfig delivery = {};
  SightConfig sight = {};
  DisturbanceConfig disturbance = {};
  FaultMemoryConfig faults = {};
};

}  // namespace boresight::health
