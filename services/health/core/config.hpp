// Settings of the health service; the defaults are what config/services/health.toml ships.
#pragma once

namespace boresight::health {

struct Config {
  double window_s = 2.0;            ///< rates, losses and latencies are judged over this time
  double min_rate_ratio = 0.7;      ///< a radar that delivers less than this share of its rate is RATE_REDUCED
  double max_rejected_ratio = 0.2;  ///< a larger share of rejected frames is INVALID_DATA
  double max_suspect_ratio = 0.1;   ///< so is a larger share of scans with an integrity verdict against them
  double restart_memory_s = 3.0;    ///< how long a service counts as restarted after it came back
  // Misalignment: an axis is beyond tolerance when even the lower end of its confidence interval is.
  double confidence_sigma = 2.33;    ///< one-sided 99 %
  double set_s = 1.0;                ///< it has to hold this long to be said …
  double clear_s = 5.0;              ///< … and the opposite this long to be taken back
  double clear_ratio = 0.9;          ///< taken back when the interval's upper end is below this share of the tolerance
  double inhibit_rad = 0.1274;       ///< 7.3°: the sensor is NOT_AVAILABLE beyond it
  double reference_range_m = 100.0;  ///< where the lateral displacement is stated
};

}  // namespace boresight::health
