// Settings of the windowed estimator.
#pragma once

#include "services/alignment_estimator/core/windows/change_monitor.hpp"
#include "services/alignment_estimator/core/windows/priors.hpp"

namespace boresight::alignment::windows {

/// Added to a memory of unknown age, beside what its fluctuations may have done since: the car may have been repaired.
/// Choice: a memory that doubts more costs seconds of driving, one that doubts less is wrong after a repair.
struct RestoreConfig {
  /// A memory that was written t seconds ago gets 1 − exp(−t/doubt_s) of these variances. Choice: a workshop turns a
  /// radar or changes tyres in ten minutes; a service that was restarted was away for a second.
  double doubt_s = 600.0;
  /// The load may have changed while nobody looked for this long (choice: to stop, to get in or out, to drive on).
  double stop_s = 20.0;
  double rotation_std_rad = 0.00175;  ///< 0.1°
  double rate_scale_std = 3e-4;
  double speed_scale_std = 0.003;  ///< tyres and their pressure
  /// Share of the prior's standard deviation, for the vehicle's other parameters.
  double vehicle_share = 0.25;
};

/// How scans become sums.
struct SumsConfig {
  double noise_memory_s = 60.0;    ///< over which the noise of a radar is learnt (choice)
  double spread_memory_s = 600.0;  ///< over which the directions that a radar sees are counted (choice)
  /// What is known of scales and yaw widens the gate by no more than this, pitch by twice the yaw: more lets slow
  /// objects in, less keeps a radar out that is not known yet (choice).
  double gate_scale = 0.005, gate_yaw_rad = 0.01;
  double start_gate_scale = 0.02;  ///< likewise, in the first seconds
  double wide_share = 0.012;       ///< of the speed: std of range rates of a radar that may have turned (choice)
  /// Smaller accelerations are noise of the signals: the time offset is not learnt from them (choice).
  double clear_acceleration_mps2 = 0.5, clear_yaw_acceleration_radps2 = 0.04;
  /// Share of the prior's standard deviation. Derivatives follow the estimate about axes that are known better; the
  /// rest stay where the radar began (first-estimates Jacobian). More: one azimuth poses as two; less: slower (choice).
  double known_share = 0.2;
};

struct WindowsConfig {
  Priors priors;
  SumsConfig sums;
  ChangeConfig change;
  RestoreConfig restore;
};

}  // namespace boresight::alignment::windows
