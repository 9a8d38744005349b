// Settings of the health service; the defaults are what config/services/health.toml ships.
#pragma once

#include "services/health/core/faults/fault_memory.hpp"
#include "services/health/core/function/delivery_monitor.hpp"
#include "services/health/core/function/sight_monitor.hpp"

namespace boresight::health {

struct Config {
  double window_s = 2.0;            ///< time window of rates, losses and latencies
  double max_rejected_ratio = 0.2;  ///< a larger share of rejected frames is INVALID_DATA
  double max_suspect_ratio = 0.1;   ///< a larger share of scans of doubtful integrity is INVALID_DATA
  double restart_memory_s = 3.0;    ///< time for which a service counts as restarted
  double start_grace_s = 5.0;       ///< time for the services to start, before one without a heartbeat is silent
  // Misalignment: an axis is beyond tolerance if the lower end of its confidence interval is.
  double confidence_sigma = 2.33;    ///< one-sided 99 %
  double set_s = 3.0;                ///< time for which an axis must be beyond its tolerance to be reported
  double clear_s = 5.0;              ///< time for which it must be within to withdraw the report
  double clear_ratio = 0.9;          ///< within: the interval's upper end is below this share of the tolerance
  double inhibit_rad = 0.1274;       ///< 7.3°: beyond it the sensor is NOT_AVAILABLE
  double reference_range_m = 100.0;  ///< range at which the lateral displacement is stated
  DeliveryConfig delivery = {};
  SightConfig sight = {};
  FaultMemoryConfig faults = {};
};

}  // namespace boresight::health
