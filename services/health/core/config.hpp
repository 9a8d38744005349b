// Settings of the health service; the defaults are what config/services/health.toml ships.
#pragma once

#include "services/health/core/faults/fault_memory.hpp"

namespace boresight::health {

struct Config {
  double window_s = 2.0;            ///< time window of rates, losses and latencies
  double min_rate_ratio = 0.7;      ///< a radar that delivers less than this share of its rate is RATE_REDUCED
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
  FaultMemoryConfig faults;
};

}  // namespace boresight::health
